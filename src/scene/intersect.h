// Where a ray x + t d first meets a shape. t counts in units of d; misses are infinite.
#pragma once

#include <limits>

#include "scene/frame.h"
#include "scene/shape.h"

namespace crescent {

struct Crossing {
    double t = std::numeric_limits<double>::infinity();  // where the surface is
    double order =
        std::numeric_limits<double>::infinity();  // where it takes its turn among the shapes (a panel: at its opening)
    Vec3d n{};                                    // geometric normal, not yet turned to the viewer
    bool reveal = false;
};

Crossing intersect(const Shape& shape, Vec3d x, Vec3d d);

/// The unit normal of a quad or of a panel's opening.
inline Vec3d quad_normal(const Shape& shape) { return normalize(cross(shape.edge_u, shape.edge_v)); }

}  // namespace crescent
