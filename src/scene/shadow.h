// Which parts of a straight edge a body hides from a point, found exactly: so a disk light can be integrated along
// straight lines with no guess about where its shadows begin. Double precision.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "scene/chord.h"
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
