// A chart of the sphere in which areas are solid angles: t = 1 - cos(theta) in [0, 2], phi in [0, 2 pi). No Jacobian is
// needed.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "base/vec.h"
#include "math/functions.h"

namespace crescent::check {

inline constexpr double two_pi = 6.283185307179586477;

/// A point on the chart.
struct ChartPoint {
    double t = 0, phi = 0;
};

/// t = r^2 / (|w| + |z|) has no cancellation at the poles. w need not have length 1.
inline ChartPoint to_chart(Vec3d w) {
    const double r2 = w.x * w.x + w.y * w.y, length = std::sqrt(r2 + w.z * w.z);
    const double a = r2 / (length * (length + std::fabs(w.z)));
    const double phi = math::atan2(w.y, w.x);
    return {w.z >= 0 ? a : 2 - a, phi < 0 ? phi + two_pi : phi};
}

inline Vec3d from_chart(ChartPoint point) {
    const double r = std::sqrt(std::max(0.0, point.t * (2 - point.t)));
    const math::SinCos azimuth = math::sincos(point.phi);
    return {r * azimuth.cos, r * azimuth.sin, 1 - point.t};
}

/// Polar angle of t, radians.
inline double angle_of(double t) { return 2 * math::asin(std::sqrt(std::clamp(t / 2, 0.0, 1.0))); }

/// A rectangle of the chart, with its solid angle and its widths as angles along theta and along phi.
struct ChartRect {
    double t0 = 0, t1 = 2, phi0 = 0, phi1 = two_pi;

    double area() const { return (t1 - t0) * (phi1 - phi0); }
    double theta_width() const { return angle_of(t1) - angle_of(t0); }
    double phi_width() const {
        const double t = (t0 + t1) / 2;
        return (phi1 - phi0) * std::sqrt(t * (2 - t));
    }
    double width(bool along_phi) const { return along_phi ? phi_width() : theta_width(); }
    double middle(bool along_phi) const { return along_phi ? (phi0 + phi1) / 2 : (t0 + t1) / 2; }
    /// The point at fractions x and y of the rectangle.
    ChartPoint at(double x, double y) const { return {t0 + (t1 - t0) * x, phi0 + (phi1 - phi0) * y}; }
};

// ---- Bands of the chart: 64 of equal width in t = 1 - cos(theta) and 64 in azimuth. The leaves of the tree divide
// both axes at once, so a thin band, such as an arc of azimuths that is never drawn, is a small part of every leaf that
// it crosses.

/// Bands along each axis: a power of 2, so that pairs of bands form wider ones. Chosen: twice as fine as the leaves of
/// a density without detail.
inline constexpr std::size_t bands = 64;

/// The axes: t, then phi.
inline constexpr std::size_t chart_axes = 2;
inline constexpr std::array<double, chart_axes> axis_length = {2, two_pi};

/// A value for each band of t, then for each band of phi.
template <class T> using ByBand = std::array<T, chart_axes * bands>;

/// The index of the band along an axis.
inline std::size_t band_of(ChartPoint point, std::size_t axis) {
    const double x = (axis == 0 ? point.t : point.phi) / axis_length[axis] * bands;
    return axis * bands + std::min(static_cast<std::size_t>(std::max(x, 0.0)), bands - 1);
}

/// One number that encodes `width` bands of an axis from `first` on, where width is a power of 2 that divides first;
/// and the rectangle of these bands.
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
    if (axis == 0) {
        out.t0 = from;
        out.t1 = from + each;
    } else {
        out.phi0 = from;
        out.phi1 = from + each;
    }
    return out;
}

}  // namespace crescent::check
