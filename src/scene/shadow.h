// Finds exactly the parts of a straight edge that a body hides from a point, so that a disk light can be integrated
// along straight lines without searching for shadow edges. Double precision.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "scene/body.h"
#include "scene/scene.h"

namespace crescent {

/// Returns the v for which the way from x to y(v) crosses the body's surface within `limits`: one interval if x is
/// outside the body, else at most two (points inside one body see each other).
std::array<Interval, 2> hidden(const Occluder& body, Vec3d x, Vec3d y0, Vec3d y1, Between limits = before_light);

/// Returns whether x is in the sphere or box; false for flat bodies.
bool holds(const Occluder& body, Vec3d x);

/// Points within a box: its middle and half its sides. A single point has no sides.
struct Extent {
    Vec3d middle{}, half{};
};

/// Returns whether a plane separates the body from all segments between these points and the light of this form, so
/// that it hides nothing. Never true if it hides some part; false if none of the tested planes separates them.
bool is_separated(const Occluder& body, const Extent& from, const Bodies::Any& light);

/// A ball that contains a body or a figure; infinite if they are.
struct Ball {
    Vec3d middle{};
    double radius = 0;
};
/// Returns a ball that contains the body: the body itself if it is one, else one around its axis-aligned box.
Ball ball_around(const Occluder& body);

/// Returns whether no part of the first ball lies on a ray from x through the second one. Cheaper than planes and
/// usually less precise; never true if some part does. With the rays' cone of half angle a about d, sin a = R/|d|, a
/// ball of radius r at c is outside it if |c_off| cos a > r + c_along sin a, with c's parts across d and along it: both
/// sides are squared, no root.
inline bool passes_by(const Ball& body, Vec3d x, const Ball& light) {
    const Vec3d d = light.middle - x, c = body.middle - x;
    const double d2 = dot(d, d), c2 = dot(c, c), cd = dot(c, d), R2 = sqr(light.radius);
    if (!(d2 > 1.01 * R2)) return false;  // so near the light the cone's angle is dominated by rounding
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

}  // namespace crescent
