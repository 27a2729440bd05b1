// Which part of a straight edge a body hides from a point. For a convex body and a point outside it, the hidden part
// of a chord is one interval, found exactly: so a disk light can be integrated chord by chord with no guess about
// where its shadow begins. Double precision.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace crescent {

/// v in [lo, hi] of the chord y(v) = y0 + v (y1 - y0), v in [0, 1]; empty where lo >= hi.
struct Interval {
    double lo = 0, hi = 0;
    bool empty() const { return !(lo < hi); }
};

/// The v for which the segment from x to y(v) crosses the body.
Interval hidden(const Occluder& body, Vec3d x, Vec3d y0, Vec3d y1);

/// The body's extent along x, y and z; infinite for a plane.
struct Bound {
    Vec3d min{}, max{};
};
Bound bound_of(const Occluder& body);

/// Could the body stand between x and any point within `radius` of `center`? Never false where it does: the cone of
/// lines is nowhere wider than `radius`, so the segment to the centre must come within `radius` of the body's extent.
bool may_hide(const Bound& bound, Vec3d x, Vec3d center, double radius);

/// [0, 1] less the given intervals, in order.
std::vector<Interval> open_parts(std::vector<Interval> hidden_parts);

}  // namespace crescent
