// Which parts of a straight edge, the chord, a body hides from a point: what the bodies' own files share. Double
// precision.
#pragma once

#include <array>

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
Interval where_negative(double a, double b, double c, Interval range);
/// v in [0, 1] with p0 + v (p1 - p0) >= 0.
Interval where_positive(double p0, double p1);
Interval both(Interval a, Interval b);
/// The smallest interval that holds two.
Interval hull(Interval a, Interval b);

/// Of a convex solid: the v whose way meets it, and those whose way begins or ends in it.
struct Met {
    Interval way, start, end;
    /// Its surface is crossed where the way meets it, unless it runs inside from start to end.
    std::array<Interval, 2> crossed() const;
};

/// Where the chord's ways cross the plane through p with normal n.
struct OnPlane {
    Vec3d at0, step;  // from p, homogeneous: way v meets the plane at (at0 + v step) / (w0 + v w1)
    double w0, w1;
    Interval sides;  // start and end lie on different sides
};
/// A point on the plane of a light, seen from a surface point.
OnPlane project(Vec3d p, Vec3d n, const Sight& s);

}  // namespace crescent::inline scene
