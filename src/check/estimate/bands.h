// Bands of the chart: 64 of equal width in t = 1 - cos(theta) and 64 in azimuth. The leaves of the tree divide both at
// once, so a thin band, such as an arc of azimuths that is never drawn, is a small part of every leaf that it crosses.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "check/estimate/chart.h"

namespace crescent::check {

/// Bands along each axis: a power of 2, so that pairs of bands make wider ones. Chosen: as fine as the leaves that a
/// density without detail gets, twice over.
inline constexpr std::size_t bands = 64;

/// The axes: t, then phi.
inline constexpr std::size_t axes = 2;
inline constexpr std::array<double, axes> axis_length = {2, two_pi};

/// A value for each band of t, then for each band of phi.
template <class T> using ByBand = std::array<T, axes * bands>;

/// The index of the band along an axis.
inline std::size_t band_of(ChartPoint at, std::size_t axis) {
    const double x = (axis == 0 ? at.t : at.phi) / axis_length[axis] * bands;
    return axis * bands + std::min(static_cast<std::size_t>(std::max(x, 0.0)), bands - 1);
}

/// One number for `width` bands of an axis from `first` on, width a power of 2 that divides first; and what they cover.
constexpr int band_member(std::size_t axis, std::size_t first, std::size_t width) {
    return static_cast<int>(2 * bands * axis + (bands + first) / width);
}
constexpr ChartRect rect_of_band(int member) {
    const auto axis = static_cast<std::size_t>(member) / (2 * bands),
               number = static_cast<std::size_t>(member) % (2 * bands);
    const std::size_t count = std::bit_floor(number);
    const double each = axis_length[axis] / static_cast<double>(count),
                 from = each * static_cast<double>(number - count);
    ChartRect out;
    if (axis == 0) out.t0 = from, out.t1 = from + each;
    else out.phi0 = from, out.phi1 = from + each;
    return out;
}

}  // namespace crescent::check
