// Shared by the bodies that may lie between a surface and a light: their numbers as kernels have them, and parts of
// their tests. Single precision there, distances in m.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/vec.h"
#include "math/simd/frame.h"

namespace crescent {

// ---- The parameters of a kind of shape or light: name in a file, type, range and member; the table of an experiment
// file and the words of a report are made from them.

/// Bounds of a number or of every number in a list.
struct Range {
    double low = 0, high = 0;
    bool low_open = false, high_open = false;
    bool holds(double x) const { return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high); }
};

inline constexpr Range place_range{-1e6, 1e6};   // m; float kernels resolve steps below a millimetre in this range
inline constexpr Range length_range{1e-6, 1e6};  // m
inline constexpr Range albedo_range{0, 1};

/// A parameter of `Kind`.
template <class Kind> struct Parameter {
    std::string_view name;
    std::variant<double Kind::*, bool Kind::*, Vec3d Kind::*, std::optional<Rgb> Kind::*> member;
    std::string_view means;
    Range range{};
    std::string_view unit{};
    bool unit_vector = false;
    std::string_view default_value{};  // "": required; a flag defaults to false
};

namespace parameter {

/// A point, m.
template <class Kind> constexpr Parameter<Kind> place(std::string_view name, Vec3d Kind::* to, std::string_view means) {
    return {name, to, means, place_range, "m"};
}
/// A length, m.
template <class Kind>
constexpr Parameter<Kind> length(std::string_view name, double Kind::* to, std::string_view means) {
    return {name, to, means, length_range, "m"};
}
/// A unit vector.
template <class Kind>
constexpr Parameter<Kind> direction(std::string_view name, Vec3d Kind::* to, std::string_view means) {
    return {name, to, means, {}, "", true};
}
template <class Kind> constexpr Parameter<Kind> flag(std::string_view name, bool Kind::* to, std::string_view means) {
    return {name, to, means, {}, "", false, "false"};
}
template <class Kind> constexpr Parameter<Kind> albedo(
    std::string_view name, std::optional<Rgb> Kind::* to, std::string_view default_value, std::string_view means) {
    return {name, to, means, albedo_range, "", false, default_value};
}

}  // namespace parameter

/// A contradiction between two parameters.
struct Mistake {
    std::string_view key;   // the key to change
    std::string_view says;  // what was expected there, what was found
};

/// A list of kinds; each has a name, a summary of one line for `crescent list`, and parameters().
template <class... Kind> struct KindList {
    static constexpr std::size_t count = sizeof...(Kind);
    using Any = std::variant<Kind...>;
    static constexpr std::array<std::string_view, count> names = {Kind::name...}, summaries = {Kind::summary...};

    /// Returns the kind at `index` with nothing set.
    static Any make(std::size_t index) {
        Any out;
        std::size_t k = 0;
        ((k++ == index ? void(out.template emplace<Kind>()) : void()), ...);
        return out;
    }
    /// Calls f(name of a kind, parameter) for every parameter of every kind, in order.
    template <class F> static constexpr void each_parameter(F&& f) {
        const auto apply = [&]<class K>(std::type_identity<K>) {
            for (const Parameter<K>& parameter : K::parameters()) f(K::name, parameter);
        };
        (apply(std::type_identity<Kind>{}), ...);
    }
};

// ---- The parts of a straight edge, the chord, that a body hides from a point: shared by the files of the bodies.
// Double precision.

/// v in [lo, hi] of the chord y(v) = y0 + v (y1 - y0), v in [0, 1]; empty where lo >= hi.
struct Interval {
    double lo = 0, hi = 0;
    bool empty() const { return !(lo < hi); }
};

/// The part of the way from the point (0) to the light (1) on which a surface counts as between them. The ends are
/// excluded, so that rounding never decides whether a body hides points of its own face.
struct Between {
    double from = 0, to = 1;
};
inline constexpr double at_an_end = 1e-5;  // fraction of the way; the kernels use it too
inline constexpr Between before_light{at_an_end, 1 - at_an_end};

/// A point, and the chord as seen from it.
struct Sight {
    Vec3d x, d0, step;  // d(v) = y(v) - x = d0 + v step
    Between limits;
};

/// Returns v in `range` with a v^2 + 2 b v + c <= 0, known to be one interval there.
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
/// Returns v in [0, 1] with p0 + v (p1 - p0) >= 0.
inline Interval where_positive(double p0, double p1) {
    if (p0 >= 0 && p1 >= 0) return {0, 1};
    if (p0 < 0 && p1 < 0) return {};
    const double root = p0 / (p0 - p1);
    return p0 < 0 ? Interval{root, 1} : Interval{0, root};
}
inline Interval both(Interval a, Interval b) { return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)}; }
/// Returns the smallest interval that contains both.
inline Interval hull(Interval a, Interval b) {
    return a.empty() ? b : b.empty() ? a : Interval{std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

/// For a convex solid: the v whose way meets it, and those whose way begins or ends in it.
struct Met {
    Interval way, start, end;
    /// Returns the v at which its surface is crossed: where the way meets it, unless it runs inside from start to end.
    std::array<Interval, 2> crossed() const {
        const Interval interior = both(start, end);
        if (interior.empty()) return {way, {}};
        return {Interval{way.lo, interior.lo}, Interval{interior.hi, way.hi}};
    }
};

/// Where the ways to the chord cross the plane through p with normal n.
struct OnPlane {
    Vec3d at0, step;  // from p, homogeneous: way v meets the plane at (at0 + v step) / (w0 + v w1)
    double w0, w1;
    Interval sides;  // start and end lie on different sides
};
/// Projects a point onto the plane of a light, seen from a surface point.
inline OnPlane project(Vec3d p, Vec3d n, const Sight& s) {
    const double hx = dot(n, s.x - p), h0 = dot(n, s.d0),
                 h1 = h0 + dot(n, s.step);  // height of x; increase along the chord
    const double sign = hx > 0 ? 1 : -1;
    // Intersection point = x - d hx / (n.d): relative to p, times -n.d, which is linear in v.
    const Vec3d g0 = sign * (-h0 * (s.x - p) + hx * s.d0), g1 = sign * (-h1 * (s.x - p) + hx * (s.d0 + s.step));
    const auto where_beyond = [&](double f, double side) {
        return where_positive(side * sign * (hx + f * h0), side * sign * (hx + f * h1));
    };
    return {.at0 = g0,
        .step = g1 - g0,
        .w0 = -sign * h0,
        .w1 = sign * (h0 - h1),
        .sides = hx == 0 ? Interval{} : both(where_beyond(s.limits.from, 1), where_beyond(s.limits.to, -1))};
}

// ---- The first intersection of a ray x + t d with a shape; t is in units of d and infinite for a miss.

struct Intersection {
    double t = std::numeric_limits<double>::infinity();      // where the surface is
    double order = std::numeric_limits<double>::infinity();  // the t by which surfaces are ordered (a panel: at its
                                                             // opening)
    Vec3d n{};                                               // geometric normal, not yet turned towards the viewer
    bool reveal = false;                                     // the side of a recessed panel
};

inline constexpr double never = std::numeric_limits<double>::infinity();

/// Returns a surface at t that is ordered by the same t.
inline Intersection crossing_at(double t, Vec3d n) { return {.t = t, .order = t, .n = n, .reveal = false}; }

/// Returns t where the ray meets the plane through `point` with normal n.
inline double plane_t(Vec3d point, Vec3d n, Vec3d x, Vec3d d) {
    const double v = dot(n, d);
    const double t = v == 0 ? never : dot(n, point - x) / v;
    return t > 0 ? t : never;
}

/// Returns t where the ray meets the parallelogram corner + a u + b v, 0 <= a, b <= 1.
inline double parallelogram_t(Vec3d corner, Vec3d u, Vec3d v, Vec3d x, Vec3d d) {
    const Vec3d w = cross(u, v);
    const double t = plane_t(corner, w, x, d);
    if (t == never) return never;
    const Vec3d p = x + t * d - corner;
    const double a = dot(cross(p, v), w) / dot(w, w), b = dot(cross(u, p), w) / dot(w, w);
    return a >= 0 && a <= 1 && b >= 0 && b <= 1 ? t : never;
}

// ---- The azimuths, as seen along an axis through a point, at which a ray may meet a body: those that half-planes
// ending in the axis must cover. Radians; double precision.

/// The azimuths [middle - half, middle + half] about the axis frame.n, counted from frame.t towards frame.b; half = pi
/// if the axis, or its other end, meets the body.
struct Azimuths {
    double middle = 0, half = pi;
    bool whole() const { return half >= pi; }
    /// Returns whether any azimuth of [lo, hi] is among them. Both may differ by several turns.
    bool meet(double lo, double hi) const;
};

/// Returns the azimuths of an ellipse around p with conjugate half-axes u and v, seen from the origin.
Azimuths azimuths_of_ellipse(Vec3d p, Vec3d u, Vec3d v, const Frame<double>& frame);
/// Returns the azimuths of a ball around p.
Azimuths azimuths_of_ball(Vec3d p, double radius, const Frame<double>& frame);
/// Returns the azimuths of the convex hull of at most eight points, seen from x.
Azimuths azimuths_of_corners(std::span<const Vec3d> corners, Vec3d x, const Frame<double>& frame);

/// A body relative to the scene's origin. The meaning of a, b, c, radius and offset depends on the kind.
struct BodyNumbers {
    Vec3d a{}, b{}, c{};
    double radius = 0, offset = 0;
};
/// The same numbers for a pack of pixels.
template <class F> struct PackedBody {
    Vec3<F> a, b, c;
    F radius, offset;
};

/// The size from which a body counts as large: in single precision its centre would be off by 5e-6 m or more. Such a
/// body is stored relative to its point nearest to the origin, m.
inline constexpr double large_body = 100;

template <class F> MaskOf<F> within(F t, F lo, F hi) { return (t > lo) & (t < hi); }

/// Returns t where o + t d meets the plane n.y = offset.
template <class F> F plane_at(Vec3<F> n, F offset, Vec3<F> o, Vec3<F> d) {
    const F denominator = dot(n, d);
    return (offset - dot(n, o)) / select(denominator == number<F>(0), number<F>(1e-30), denominator);
}

/// Returns how far a disk of unit normal n and radius 1 extends along `axis` from its centre.
double disk_reach(Vec3d axis, Vec3d n);

}  // namespace crescent
