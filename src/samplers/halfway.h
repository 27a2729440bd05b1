// Shared by the half-vector samplers: m is drawn about n, wi is wo mirrored in m, and
//   dw_i = 4 (wo.m) dw_m,  so    p(wi) = p_m(m) / (4 (wo.m)).        Walter et al. 2007, eq. (14)
// If wi is below the horizon nothing is drawn: the sample has weight 0 and counts, and p is not renormalised, so its
// integral is one minus that share. (Below the horizon p would grow without bound towards wi = -wo.)
#pragma once

#include "samplers/sampler.h"

namespace crescent {

template <class F> F half_jacobian(F wo_m) { return number<F>(4) * larger(wo_m, number<F>(1e-12)); }

/// The half-vector of two directions above the horizon.
template <class F> Vec3<F> halfway(Vec3<F> wo, Vec3<F> wi) {
    const Vec3<F> sum = wo + wi;
    return sum * (number<F>(1) / sqrt(larger(dot(sum, sum), number<F>(1e-30))));
}

/// Returns p if wo and wi are above the horizon, else 0.
template <class F> PerSr<F> above(Vec3<F> wo, Vec3<F> wi, F p) {
    return {select((wo.z > number<F>(0)) & (wi.z > number<F>(0)), p, number<F>(0))};
}

/// wo mirrored in the unit vector m.
template <class F> Vec3<F> mirror_about(Vec3<F> wo, Vec3<F> m) { return m * (number<F>(2) * dot(wo, m)) - wo; }

/// wo in the space where the lobe of width alpha is a hemisphere.        Heitz 2018, section 3.2
template <class F> Vec3<F> stretched_by(F alpha, Vec3<F> wo) {
    return normalize(Vec3<F>{alpha * wo.x, alpha * wo.y, wo.z});
}
/// Returns the normal halfway between `stretched` and the direction (sin, phi, rise - stretched.z) of the cap,
/// transformed back.
template <class F> Vec3<F> normal_from_cap(F alpha, Vec3<F> stretched, F sin, SinCos<F> phi, F rise) {
    return normalize(Vec3<F>{alpha * (sin * phi.cos + stretched.x), alpha * (sin * phi.sin + stretched.y), rise});
}

}  // namespace crescent
