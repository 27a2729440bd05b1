// Directions in single and double precision, as renderers compute them.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec.h"
#include "math/simd/frame.h"
#include "math/simd/scalar.h"

namespace crescent::calibration {

template <class F> constexpr F pi_of = std::numbers::pi_v<F>;
/// Tolerance for the rounding of a direction's coordinates at a boundary: a few units in the last place.
template <class F> constexpr F slack = sizeof(F) == 4 ? F(4e-7) : F(1e-14);

template <class F> Vec3<F> unit(Vec3<F> v) { return v * (F(1) / std::sqrt(dot(v, v))); }
template <class F> Vec3<F> cast(Vec3d v) { return {F(v.x), F(v.y), F(v.z)}; }
template <class F> Vec3d widened(Vec3<F> v) { return {double(v.x), double(v.y), double(v.z)}; }
template <class F> Vec3<F> reflected(Vec3<F> wo, Vec3<F> m) { return m * (2 * dot(wo, m)) - wo; }

/// 1 - cos of the angle between two unit vectors, without cancellation.
template <class F> F versine(Vec3<F> a, Vec3<F> b) {
    const Vec3<F> d = a - b;
    return dot(d, d) / 2;
}
/// The direction at angle theta from `axis`, t = 1 - cos(theta), with azimuth `turns` about it.
template <class F> Vec3<F> off_axis(Vec3<F> axis, F t, F turns) {
    const F s = std::sqrt(std::max(t * (2 - t), F(0))), phi = 2 * pi_of<F> * turns;
    return frame_about(axis).to_world(Vec3<F>{s * std::cos(phi), s * std::sin(phi), 1 - t});
}
/// Cosine-weighted about +z: x, y on the unit disk, polar.
template <class F> Vec3<F> cosine_weighted(F u1, F u2) {
    const F r = std::sqrt(u1), phi = 2 * pi_of<F> * u2;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u1)};
}
/// Azimuth of w in turns, [0, 1).
template <class F> F turns_of(Vec3<F> w) {
    const F t = std::atan2(w.y, w.x) / (2 * pi_of<F>);
    return t < 0 ? std::min(t + 1, std::nextafter(F(1), F(0))) : t;
}

}  // namespace crescent::calibration
