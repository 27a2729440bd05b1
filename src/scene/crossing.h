// Where a ray x + t d first meets a shape. t counts in units of d; misses are infinite.
#pragma once

#include <limits>

#include "base/vec.h"

namespace crescent::inline scene {

struct Intersection {
    double t = std::numeric_limits<double>::infinity();      // where the surface is
    double order = std::numeric_limits<double>::infinity();  // where it takes its turn (a panel: at its opening)
    Vec3d n{};                                               // geometric normal, not yet turned to the viewer
    bool reveal = false;                                     // the side of a recessed panel
};

inline constexpr double never = std::numeric_limits<double>::infinity();

/// A surface at t that takes its turn there.
inline Intersection crossing_at(double t, Vec3d n) { return {t, t, n, false}; }

/// t where the ray meets the plane through `point` with normal n.
inline double plane_t(Vec3d point, Vec3d n, Vec3d x, Vec3d d) {
    const double v = dot(n, d);
    const double t = v == 0 ? never : dot(n, point - x) / v;
    return t > 0 ? t : never;
}

/// t where the ray meets the parallelogram corner + a u + b v, 0 <= a, b <= 1.
inline double parallelogram_t(Vec3d corner, Vec3d u, Vec3d v, Vec3d x, Vec3d d) {
    const Vec3d w = cross(u, v);
    const double t = plane_t(corner, w, x, d);
    if (t == never) return never;
    const Vec3d p = x + t * d - corner;
    const double a = dot(cross(p, v), w) / dot(w, w), b = dot(cross(u, p), w) / dot(w, w);
    return a >= 0 && a <= 1 && b >= 0 && b <= 1 ? t : never;
}

}  // namespace crescent::inline scene
