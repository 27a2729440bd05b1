// One fan of directions from a surface point: the half-plane that ends in an axis, and the line in which it cuts a
// light. Directions in it are cos(al) axis + sin(al) aside, al in [0, pi]; double precision.
#pragma once

#include "math/functions.h"
#include "reference/disk_point.h"
#include "scene/figure.h"
#include "scene/shadow.h"

namespace crescent::inline reference {

/// sin(al), cos(al), al.
struct Direction {
    double sin, cos, al;
};

struct Fan {
    Vec3d axis, aside;
    Vec3d to0{}, step{};  // from the point to where the light begins, and on to where it ends
    bool empty = true;

    Fan(const DiskPoint& point, const Figure& light, const Frame<double>& about, const math::SinCos& azimuth);
    /// Towards the light's point v of the way from its beginning to its end.
    Direction at(double v) const;
    /// Leaves the part that is above the surface's horizon; to.al < from.al where none is.
    void rise_above(const DiskPoint& point, Direction& from, Direction& to) const;
    /// Integral of cos(theta_i) sin(al) over a part that is above the horizon, in closed form.
    double lambert(const DiskPoint& point, const Direction& from, const Direction& to) const;
};

}  // namespace crescent::inline reference
