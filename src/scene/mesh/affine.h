// Affine transforms of space: where an instance of a mesh is placed. Double precision; lengths in m, angles in degrees.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec.h"
#include "math/functions.h"

namespace crescent {

/// p -> p.x x + p.y y + p.z z + shift.
struct Affine {
    Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, shift{0, 0, 0};

    Vec3d vector(Vec3d v) const { return v.x * x + v.y * y + v.z * z; }
    Vec3d point(Vec3d p) const { return vector(p) + shift; }
    /// Returns the image of a plane's normal, not of unit length: the cofactors, which keep its side for det() > 0.
    Vec3d normal(Vec3d n) const { return n.x * cross(y, z) + n.y * cross(z, x) + n.z * cross(x, y); }
    double det() const { return dot(x, cross(y, z)); }
    /// Returns the transform that applies `inner` first.
    Affine after(const Affine& inner) const {
        return {.x = vector(inner.x), .y = vector(inner.y), .z = vector(inner.z), .shift = point(inner.shift)};
    }
    /// Needs det() != 0.
    Affine inverse() const {
        const double scale = 1 / det();
        const Vec3d r0 = scale * cross(y, z), r1 = scale * cross(z, x), r2 = scale * cross(x, y);
        Affine out = {.x = {r0.x, r1.x, r2.x}, .y = {r0.y, r1.y, r2.y}, .z = {r0.z, r1.z, r2.z}, .shift = {}};
        out.shift = -out.vector(shift);
        return out;
    }
    /// Returns an upper bound of the length of the image of a unit vector: the Frobenius norm.
    double stretch() const { return std::sqrt(dot(x, x) + dot(y, y) + dot(z, z)); }
};

/// Returns the translation by `to`.
inline Affine translation(Vec3d to) { return {.x = {1, 0, 0}, .y = {0, 1, 0}, .z = {0, 0, 1}, .shift = to}; }
/// Returns the scaling of each axis.
inline Affine scaling(Vec3d factors) {
    return {.x = {factors.x, 0, 0}, .y = {0, factors.y, 0}, .z = {0, 0, factors.z}, .shift = {}};
}
/// Returns the rotation about the x axis, then the y axis, then the z axis, counterclockwise seen from each axis' end.
inline Affine rotation(Vec3d degrees) {
    const auto sin_cos = [](double angle) { return math::sincos(angle * (3.14159265358979323846 / 180)); };
    const auto [sx, cx] = sin_cos(degrees.x);
    const auto [sy, cy] = sin_cos(degrees.y);
    const auto [sz, cz] = sin_cos(degrees.z);
    const Affine about_x = {.x = {1, 0, 0}, .y = {0, cx, sx}, .z = {0, -sx, cx}, .shift = {}},
                 about_y = {.x = {cy, 0, -sy}, .y = {0, 1, 0}, .z = {sy, 0, cy}, .shift = {}},
                 about_z = {.x = {cz, sz, 0}, .y = {-sz, cz, 0}, .z = {0, 0, 1}, .shift = {}};
    return about_z.after(about_y.after(about_x));
}

}  // namespace crescent
