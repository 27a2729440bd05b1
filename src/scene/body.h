// What the bodies that stand between a surface and a light share: their numbers as kernels have them, and parts of
// their tests. Single precision there, distances in m.
#pragma once

#include "base/vec.h"
#include "scene/azimuth.h"
#include "scene/chord.h"
#include "scene/crossing.h"
#include "simd/frame.h"
#include "scene/parameter.h"

namespace crescent::inline scene {

/// A body from the scene's origin. What a, b, c, radius and offset are is each kind's own.
struct BodyNumbers {
    Vec3d a{}, b{}, c{};
    double radius = 0, offset = 0;
};
/// The same for a pack of pixels.
template <class F> struct PackedBody {
    Vec3<F> a, b, c;
    F radius, offset;
};

/// From here on a body is large: in single precision its centre would lie 5e-6 m and more from where it is. Such a body
/// is held by what is nearest of it, m.
inline constexpr double large_body = 100;

template <class F> MaskOf<F> within(F t, F lo, F hi) { return (t > lo) & (t < hi); }

/// t where o + t d meets the plane n.y = offset.
template <class F> F plane_at(Vec3<F> n, F offset, Vec3<F> o, Vec3<F> d) {
    const F denominator = dot(n, d);
    return (offset - dot(n, o)) / select(denominator == number<F>(0), number<F>(1e-30), denominator);
}

/// How far a disk of unit normal n reaches along `axis` from its centre, for radius 1.
double disk_reach(Vec3d axis, Vec3d n);

}  // namespace crescent::inline scene
