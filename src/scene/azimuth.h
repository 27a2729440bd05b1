// Seen along an axis through a point, the azimuths at which a body may be met: what the half-planes that end in the
// axis have to cross. Radians; double precision.
#pragma once

#include <span>

#include "simd/frame.h"

namespace crescent::inline scene {

/// The azimuths [middle - half, middle + half] about the axis frame.n, counted from frame.t towards frame.b; half = pi
/// where the axis, or its other end, meets the body.
struct Azimuths {
    double middle = 0, half = pi;
    bool whole() const { return half >= pi; }
    /// Is any azimuth of [lo, hi] among them? Both may lie several turns away.
    bool meet(double lo, double hi) const;
};

/// An ellipse about p with conjugate half-axes u and v, seen from the origin.
Azimuths azimuths_of_ellipse(Vec3d p, Vec3d u, Vec3d v, const Frame<double>& frame);
/// A ball about p.
Azimuths azimuths_of_ball(Vec3d p, double radius, const Frame<double>& frame);
/// The hull of some points, at most eight, seen from x.
Azimuths azimuths_of_corners(std::span<const Vec3d> corners, Vec3d x, const Frame<double>& frame);

}  // namespace crescent::inline scene
