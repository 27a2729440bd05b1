// ggx: microfacets of the GGX distribution.
//   D G1 G1 / (4 cos cos), separable G    Walter et al. 2007, "Microfacet Models for Refraction through Rough
//                                         Surfaces", eqs (20), (33), (34)
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/lobes/lobe.h"

namespace crescent {

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
    static constexpr LobeDoc manual = {.label = "GGX",
        .summary = "microfacets of the GGX distribution with roughness alpha",
        .formula = R"(\frac{D(h)\,G_1(\omega_o)\,G_1(\omega_i)}{4(n\cdot\omega_o)(n\cdot\omega_i)})",
        .parameter = LobeParameter::alpha,
        .own_arm = "ggx-vndf"};
    Ggx<F> ggx;
    GgxLobe(F, F alpha) : ggx{alpha} {}
    [[gnu::always_inline]] F operator()(Vec3<F> wo, Vec3<F> wi) const {  // (20)
        const F f = ggx.D(normalize(wo + wi)) * ggx.G1(wo) * ggx.G1(wi) / (number<F>(4) * wo.z * wi.z);
        return both_above(wo, wi, f);
    }

    static double exponent(double, double alpha) { return 2 / sqr(alpha); }
    /// Its tail is a power law and has no end.
    static LobeWidth width(double, double alpha) { return {2 * alpha, pi}; }

    struct Normals {
        Ggx<double> ggx;
        Normals(double, double alpha) : ggx{alpha} {}
        double height(double u) const { return std::sqrt((1 - u) / (1 + (ggx.alpha * ggx.alpha - 1) * u)); }
        double below(double c) const { return (1 - c * c) / (1 + (ggx.alpha * ggx.alpha - 1) * c * c); }
        double density(double c) const { return ggx.D({std::sqrt(std::max(0.0, 1 - c * c)), 0, c}) * c; }
    };
};

}  // namespace crescent
