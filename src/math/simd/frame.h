// Orthonormal frames and the local shading frame: n = +z, wo is given, wi is drawn, both leave the surface.
#pragma once

#include "base/vec.h"
#include "math/simd/math.h"

namespace crescent {

template <class F> struct Frame {
    Vec3<F> t, b, n;
    [[gnu::always_inline]] Vec3<F> to_world(Vec3<F> w) const { return t * w.x + b * w.y + n * w.z; }
    Vec3<F> to_local(Vec3<F> w) const { return {dot(w, t), dot(w, b), dot(w, n)}; }
};

/// A frame about the unit vector n without a pole: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
template <class F> CRESCENT_INLINE Frame<F> frame_about(Vec3<F> n) {
    const F one = number<F>(1);
    const F sign = select(n.z >= number<F>(0), one, -one);
    const F a = -one / (sign + n.z);
    const F b = n.x * n.y * a;
    return {{one + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

/// R = reflect(-wo, n) in the local frame.
template <class F> CRESCENT_INLINE Vec3<F> mirror(Vec3<F> wo) { return {-wo.x, -wo.y, wo.z}; }

}  // namespace crescent
