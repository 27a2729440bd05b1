// A colour: three numbers of linear Rec.709, and what it is worth to the eye.
#pragma once

#include <array>

namespace crescent::inline color {

using Rgb = std::array<double, 3>;  // linear Rec.709

/// Weights of linear Rec.709 luminance, ITU-R BT.709.
inline constexpr double luminance_weights[3] = {0.2126, 0.7152, 0.0722};

template <class C> double luminance(const C& rgb) {
    return luminance_weights[0] * rgb[0] + luminance_weights[1] * rgb[1] + luminance_weights[2] * rgb[2];
}

}  // namespace crescent::inline color
