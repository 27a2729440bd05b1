// Which parts of a straight edge, the chord, a body hides from a point: what the bodies' own files share. Double
// precision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/vec.h"

namespace crescent::inline scene {

/// v in [lo, hi] of the chord y(v) = y0 + v (y1 - y0), v in [0, 1]; empty where lo >= hi.
struct Interval {
    double lo = 0, hi = 0;
    bool empty() const { return !(lo < hi); }
};

/// The part of the way from the point (0) to the light (1) on which a surface stands in between. The ends are left out,
/// so that rounding never decides whether a body hides what lies in its own face.
struct Between {
    double from = 0, to = 1;
};
inline constexpr double at_an_end = 1e-5;  // of the way; the kernels' share too
inline constexpr Between before_light{at_an_end, 1 - at_an_end};

/// A point, and the chord as seen from it.
struct Sight {
    Vec3d x, d0, step;  // d(v) = y(v) - x = d0 + v step
    Between between;
};

/// v in `range` with a v^2 + 2 b v + c <= 0, known to be one interval there.
inline Interval where_negative(double a, double b, double c, Interval range) {
    if (range.empty()) return {};
    std::array<double, 4> cut = {range.lo, range.lo, range.hi, range.hi};
    const double discriminant = b * b - a * c;
    if (discriminant > 0) {
        const double q =
            -(b + std::copysign(std::sqrt(discriminant), b));  // Numerical Recipes (5.6.4): no cancellation
        double r0 = q / a, r1 = c / q;
        if (!(r0 < r1)) std::swap(r0, r1);
        if (r0 > range.lo && r0 < range.hi) cut[1] = r0;
        if (r1 > range.lo && r1 < range.hi) cut[2] = r1;
    }
    Interval out{range.hi, range.lo};
    for (std::size_t i = 0; i < 3; ++i) {
        const double middle = 0.5 * (cut[i] + cut[i + 1]);
        if (cut[i] < cut[i + 1] && (a * middle + 2 * b) * middle + c <= 0)
            out = {std::min(out.lo, cut[i]), std::max(out.hi, cut[i + 1])};
    }
    return out;
}
/// v in [0, 1] with p0 + v (p1 - p0) >= 0.
inline Interval where_positive(double p0, double p1) {
    if (p0 >= 0 && p1 >= 0) return {0, 1};
    if (p0 < 0 && p1 < 0) return {};
    const double root = p0 / (p0 - p1);
    return p0 < 0 ? Interval{root, 1} : Interval{0, root};
}
inline Interval both(Interval a, Interval b) { return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)}; }
/// The smallest interval that holds two.
inline Interval hull(Interval a, Interval b) {
    return a.empty() ? b : b.empty() ? a : Interval{std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

/// Of a convex solid: the v whose way meets it, and those whose way begins or ends in it.
struct Met {
    Interval way, start, end;
    /// Its surface is crossed where the way meets it, unless it runs inside from start to end.
    std::array<Interval, 2> crossed() const {
        const Interval inside = both(start, end);
        if (inside.empty()) return {way, {}};
        return {Interval{way.lo, inside.lo}, Interval{inside.hi, way.hi}};
    }
};

/// Where the chord's ways cross the plane through p with normal n.
struct OnPlane {
    Vec3d at0, step;  // from p, homogeneous: way v meets the plane at (at0 + v step) / (w0 + v w1)
    double w0, w1;
    Interval sides;  // start and end lie on different sides
};
/// A point on the plane of a light, seen from a surface point.
inline OnPlane project(Vec3d p, Vec3d n, const Sight& s) {
    const double hx = dot(n, s.x - p), h0 = dot(n, s.d0),
                 h1 = h0 + dot(n, s.step);  // height of x; rise along the chord's ends
    const double sign = hx > 0 ? 1 : -1;
    // Intersection point = x - d hx / (n.d): relative to p, times -n.d, which is linear in v.
    const Vec3d g0 = sign * (-h0 * (s.x - p) + hx * s.d0), g1 = sign * (-h1 * (s.x - p) + hx * (s.d0 + s.step));
    const auto beyond = [&](double f, double side) {
        return where_positive(side * sign * (hx + f * h0), side * sign * (hx + f * h1));
    };
    return {g0, g1 - g0, -sign * h0, sign * (h0 - h1),
        hx == 0 ? Interval{} : both(beyond(s.between.from, 1), beyond(s.between.to, -1))};
}

}  // namespace crescent::inline scene
