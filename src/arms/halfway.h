// What the half-vector arms share: m is drawn about n, wi is wo mirrored in m, and
//   dw_i = 4 |wo.m| dw_m,  hence  p(wi) = p_m(m) / (4 |wo.m|).        Walter et al. 2007, eq. (14)
// Under the horizon m with wo.m < 0 still sends wi somewhere: m and -m give the same wi, so m is taken with m.z > 0 and
// the density integrates to one over the whole sphere.
#pragma once

#include "arms/sampler.h"

namespace crescent {

template <class F> struct Halfway {
    Vec3<F> m;
    F jacobian;  // 4 |wo.m|, kept above 0
};

template <class F> F half_jacobian(F wo_m) { return number<F>(4) * larger(abs(wo_m), number<F>(1e-12)); }

template <class F> Halfway<F> halfway(Vec3<F> wo, Vec3<F> wi) {
    const Vec3<F> sum = wo + wi;
    const F length2 = larger(dot(sum, sum), number<F>(1e-30));
    const F scale = select(sum.z < number<F>(0), number<F>(-1), number<F>(1)) / sqrt(length2);
    const Vec3<F> m = sum * scale;
    return {m, half_jacobian(dot(wo, m))};
}

/// wo mirrored in the unit vector m.
template <class F> Vec3<F> mirror_about(Vec3<F> wo, Vec3<F> m) { return m * (number<F>(2) * dot(wo, m)) - wo; }

}  // namespace crescent
