// The BRDFs, Fresnel apart: f = rho_d / pi + rho_s * lobe. A lobe is a number in 1/sr without the cosine, in the local
// frame (n = +z). Each reads like its paper.
//
//   PhongLobe       (s+2)/(2 pi) (wi.R)_+^s                 Lafortune & Willems 1994, "Using the modified Phong BRDF"
//   BlinnPhongLobe  (s+2)(s+4)/(8 pi (2^(-s/2) + s)) (n.h)^s  Giesen 2009, "Phong and Blinn-Phong normalization
//   factors" GgxLobe         D G1 G1 / (4 cos cos), separable G       Walter et al. 2007, eqs (20), (33), (34)
#pragma once

#include <string_view>

#include "simd/frame.h"

namespace crescent {

/// rho_s = 0: nothing but Lambert.
template <class F> struct NoLobe {
    static constexpr std::string_view name = "lambert";
    static constexpr bool present = false;
    NoLobe(F, F) {}
    F operator()(Vec3<F>, Vec3<F>) const { return number<F>(0); }
};

template <class F> struct PhongLobe {
    static constexpr std::string_view name = "phong";
    static constexpr bool present = true;
    F s, scale;
    PhongLobe(F s_, F) : s(s_), scale((s_ + number<F>(2)) * number<F>(0.5 / pi)) {}
    [[gnu::always_inline]] F operator()(Vec3<F> wo, Vec3<F> wi) const {
        return scale * cosine_power(wi, mirror(wo), s);
    }
};

template <class F> struct BlinnPhongLobe {
    static constexpr std::string_view name = "blinn-phong";
    static constexpr bool present = true;
    F s, scale;
    BlinnPhongLobe(F s_, F)
        : s(s_),
          scale((s_ + number<F>(2)) * (s_ + number<F>(4)) / (number<F>(8 * pi) * (exp2(number<F>(-0.5) * s_) + s_))) {}
    [[gnu::always_inline]] F operator()(Vec3<F> wo, Vec3<F> wi) const {
        const F f = scale * cosine_power(normalize(wo + wi), Vec3<F>{number<F>(0), number<F>(0), number<F>(1)}, s);
        return select((wo.z > number<F>(0)) & (wi.z > number<F>(0)), f, number<F>(0));
    }
};

template <class F> struct Ggx {
    F alpha;  // (0, 1]

    F D(Vec3<F> m) const {  // (33), 1/sr; the denominator without cancellation at the pole
        const F sin2 = m.x * m.x + m.y * m.y;
        const F t = sin2 + sqr(alpha) * sqr(m.z);
        return select(m.z > number<F>(0), sqr(alpha) / (number<F>(pi) * sqr(t)), number<F>(0));
    }
    F G1(Vec3<F> w) const {  // (34)
        const F tan2 = (w.x * w.x + w.y * w.y) / sqr(w.z);
        return number<F>(2) / (number<F>(1) + sqrt(number<F>(1) + sqr(alpha) * tan2));
    }
};

template <class F> struct GgxLobe {
    static constexpr std::string_view name = "ggx";
    static constexpr bool present = true;
    Ggx<F> ggx;
    GgxLobe(F, F alpha) : ggx{alpha} {}
    [[gnu::always_inline]] F operator()(Vec3<F> wo, Vec3<F> wi) const {  // (20)
        const F f = ggx.D(normalize(wo + wi)) * ggx.G1(wo) * ggx.G1(wi) / (number<F>(4) * wo.z * wi.z);
        return select((wo.z > number<F>(0)) & (wi.z > number<F>(0)), f, number<F>(0));
    }
};

}  // namespace crescent
