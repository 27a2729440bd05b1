// What a lobe is: f = rho_d / pi + rho_s * lobe, Fresnel apart. A number in 1/sr without the cosine, in the local frame
// (n = +z), of a surface's s and alpha.
#pragma once

#include "lobes/info.h"
#include "math/functions.h"
#include "simd/frame.h"

namespace crescent::inline lobes {

/// rho_s = 0: nothing but Lambert.
template <class F> struct NoLobe {
    static constexpr std::string_view name = "lambert";
    static constexpr bool present = false;
    NoLobe(F, F) {}
    F operator()(Vec3<F>, Vec3<F>) const { return number<F>(0); }
};

/// f where wo and wi are above the horizon, else 0: half vectors mean nothing below it.
template <class F> CRESCENT_INLINE F both_above(Vec3<F> wo, Vec3<F> wi, F f) {
    return select((wo.z > number<F>(0)) & (wi.z > number<F>(0)), f, number<F>(0));
}

// A lobe about the half vector m states, for the table of its albedo (reference/lobe_albedo.h), how its own
// distribution draws m about n, in double: struct Normals with Normals(s, alpha),
//   height(u)   the cosine (n.m) that u in [0, 1] draws,
//   below(cos)  the u that draws an m of that cosine,
//   density(cos)  of m at that cosine, 1/sr.
// Any other lobe states static double albedo(s, alpha, cos_o, integrate), integrate(f, a, b) being an adaptive rule.

}  // namespace crescent::inline lobes
