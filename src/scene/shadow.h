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

/// A sphere around the body; radius infinite for a plane.
struct Bound {
    Vec3d center{};
    double radius = 0;
};
Bound bound_of(const Occluder& body);

/// [0, 1] less the given intervals, in order.
std::vector<Interval> open_parts(std::vector<Interval> hidden_parts);

}  // namespace crescent
