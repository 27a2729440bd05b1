// Seen along an axis through a point, the azimuths at which a body may be met: what the half-planes that end in the
// axis have to cross. Radians; double precision.
#pragma once

#include "scene/scene.h"

namespace crescent {

/// The azimuths [middle - half, middle + half] about the axis frame.n, counted from frame.t towards frame.b; half = pi
/// where the axis, or its other end, meets the body.
struct Azimuths {
    double middle = 0, half = pi;
    bool whole() const { return half >= pi; }
    /// Is any azimuth of [lo, hi] among them? Both may lie several turns away.
    bool meet(double lo, double hi) const;
};

Azimuths azimuths_of(const Occluder& body, Vec3d x, const Frame<double>& frame);

}  // namespace crescent
