// Which parts of a straight edge a body hides from a point, found exactly: so a disk light can be integrated along
// straight lines with no guess about where its shadows begin. Double precision.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "scene/body.h"
#include "scene/scene.h"

namespace crescent::inline scene {

/// The v for which the way from x to y(v) crosses the body's surface within `between`: one interval where x is outside
/// the body, at most two else (what lies in one body sees each other).
std::array<Interval, 2> hidden(const Occluder& body, Vec3d x, Vec3d y0, Vec3d y1, Between between = before_light);

/// Is x in the sphere or box? Nothing lies in the flat ones.
bool holds(const Occluder& body, Vec3d x);

/// Points within a box: its middle and half its sides. A single point has no sides.
struct Extent {
    Vec3d middle{}, half{};
};

/// A plane parts the body from all segments between these points and the light, which has this form: it hides nothing
/// of it from any. Never true where it does hide some; false where none of the planes that are tried parts them.
bool is_separated(const Occluder& body, const Extent& from, const Bodies::Any& light);

/// Holds a body, or a figure: without end where they are.
struct Ball {
    Vec3d middle{};
    double radius = 0;
};
/// A ball that holds the body: its own where it is one, else one about its box along the axes of the world.
Ball ball_around(const Occluder& body);

/// Nothing of the first ball lies on a ray from x through the second one. Cheaper than planes, and seldom as good;
/// never true where it is not so. With the rays' cone of half angle a about d, sin a = R/|d|, a ball of radius r at c
/// is off it where |c_off| cos a > r + c_along sin a, with c's parts across d and along it: both sides are squared, no
/// root.
inline bool passes_by(const Ball& body, Vec3d x, const Ball& light) {
    const Vec3d d = light.middle - x, c = body.middle - x;
    const double d2 = dot(d, d), c2 = dot(c, c), cd = dot(c, d), R2 = sqr(light.radius);
    if (!(d2 > 1.01 * R2)) return false;  // so near the light the cone's angle is lost in rounding
    const double reach = body.radius * d2 + cd * light.radius;
    constexpr double rounding = 1e-12;
    return reach < 0 || ((1 - rounding) * c2 * d2 - sqr(cd)) * (d2 - R2) > sqr(reach);
}

/// Calls f with each part of [0, 1] that no interval covers, in order. Sorts the intervals.
template <class F> void each_open_part(std::span<Interval> hidden_parts, F&& f) {
    if (hidden_parts.size() > 1)
        std::sort(hidden_parts.begin(), hidden_parts.end(), [](Interval a, Interval b) { return a.lo < b.lo; });
    double from = 0;
    for (const Interval& part : hidden_parts) {
        if (part.empty()) continue;
        if (part.lo > from) f(Interval{from, part.lo});
        from = std::max(from, part.hi);
    }
    if (from < 1) f(Interval{from, 1});
}

}  // namespace crescent::inline scene
