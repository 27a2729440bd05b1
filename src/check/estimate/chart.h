// A chart of the sphere in which areas are solid angles: t = 1 - cos(theta) in [0, 2], phi in [0, 2 pi). No Jacobian
// appears anywhere.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec.h"
#include "math/functions.h"

namespace crescent::check {

inline constexpr double two_pi = 6.283185307179586477;

/// A place on the chart.
struct ChartPoint {
    double t = 0, phi = 0;
};

/// t = r^2 / (|w| + |z|) does not cancel at the poles. w need not have length 1.
inline ChartPoint to_chart(Vec3d w) {
    const double r2 = w.x * w.x + w.y * w.y, length = std::sqrt(r2 + w.z * w.z);
    const double a = r2 / (length * (length + std::fabs(w.z)));
    const double phi = math::atan2(w.y, w.x);
    return {w.z >= 0 ? a : 2 - a, phi < 0 ? phi + two_pi : phi};
}

inline Vec3d from_chart(ChartPoint at) {
    const double r = std::sqrt(std::max(0.0, at.t * (2 - at.t)));
    const math::SinCos around = math::sincos(at.phi);
    return {r * around.cos, r * around.sin, 1 - at.t};
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
    /// The place at fractions x and y of the rectangle.
    ChartPoint at(double x, double y) const { return {t0 + (t1 - t0) * x, phi0 + (phi1 - phi0) * y}; }
};

}  // namespace crescent::check
