// Tone mapping, linear Rec.709 radiance -> 8-bit sRGB: exposure, Khronos PBR Neutral, IEC 61966-2-1. Used for
// photographs, never for metrics.
#pragma once

#include <array>

#include "base/vec.h"

namespace crescent {

/// 8-bit sRGB, as in a PNG.
using Srgb8 = std::array<unsigned char, 3>;

/// Khronos PBR Neutral: linear Rec.709 >= 0 (1: diffuse white) -> linear in [0, 1]. Hue is kept, except for a
/// desaturation of values far above white. Source: KhronosGroup/ToneMapping, PBR_Neutral, "The specification", 2024.
Rgb neutral(const Rgb& colour);

/// IEC 61966-2-1:1999 opto-electronic transfer: linear -> encoded, both in [0, 1] (clamped).
double srgb_encode(double linear);
/// Its inverse: encoded -> linear, both in [0, 1] (clamped).
double srgb_decode(double encoded);
/// Returns round(255 srgb_encode(linear)) by comparison with the 255 exact thresholds, without a power.
unsigned char srgb_byte(double linear);

/// The colour of a pixel that is NaN: pure magenta, which Neutral never yields from a lit scene.
inline constexpr Srgb8 not_a_number_colour{255, 0, 255};

/// Returns srgb_byte(neutral(exposure * radiance)) per channel; negative radiance counts as 0, a value that is not
/// finite gives `not_a_number_colour`.
Srgb8 photograph(const Rgb& radiance, double exposure);

// ---- Turbo, a rainbow map with even steps of lightness on either side of its middle, for maps of numbers. Source: A.
// Mikhailov, "Turbo, An Improved Rainbow Colormap for Visualization", Google AI Blog, 20 August 2019.

/// t in [0, 1] (clamped) -> sRGB, linear between the 256 published entries. NaN: `not_a_number_colour`.
Srgb8 turbo(double t);

// ---- The two themes of plates.

/// Ground and colours of plates: light on a dark ground, or dark on a light one.
enum class Theme { dark, light };

}  // namespace crescent
