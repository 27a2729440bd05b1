// Turbo, a rainbow map with even steps of lightness on either side of its middle, for maps of numbers. Source: A.
// Mikhailov, "Turbo, An Improved Rainbow Colormap for Visualization", Google AI Blog, 20 August 2019.
#pragma once

#include "output/tone_map.h"

namespace crescent::inline output {

/// t in [0, 1] (clamped) -> sRGB, linear between the 256 published entries. NaN: `not_a_number_colour`.
Srgb8 turbo(double t);

// ---- The two themes of plates.

/// Ground and colours of plates: light on a dark ground, or dark on a light one.
enum class Theme { dark, light };

}  // namespace crescent::inline output
