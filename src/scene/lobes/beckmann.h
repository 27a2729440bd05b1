// beckmann: microfacets of the Beckmann distribution, whose slopes are Gaussian.
//   D G1 G1 / (4 cos cos), separable G    Walter et al. 2007, "Microfacet Models for Refraction through Rough
//                                         Surfaces", eqs (20), (25) and (26)
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/lobes/lobe.h"

namespace crescent {

template <class F> struct Beckmann {
    F alpha;  // (0, 1]

    F D(Vec3<F> m) const {  // (25), 1/sr: exp(-tan^2 / alpha^2) / (pi alpha^2 cos^4)
        const F cos2 = sqr(m.z), x = (m.x * m.x + m.y * m.y) / (cos2 * sqr(alpha));
        const F denominator = number<F>(pi) * sqr(alpha) * larger(sqr(cos2), number<F>(1e-30));
        return select(m.z > number<F>(0), exp2(x * number<F>(-1.4426950408889634)) / denominator, number<F>(0));
    }
    /// (26): 2 / (1 + erf(a) + exp(-a^2) / (a sqrt(pi))), a = 1 / (alpha tan), to 1e-7, with
    /// erf(a) = 1 - P(1 / (1 + 0.3275911 a)) exp(-a^2): Abramowitz & Stegun 1964, 7.1.26.
    F G1(Vec3<F> w) const {
        const F sin = larger(sqrt(w.x * w.x + w.y * w.y), number<F>(1e-30));
        const F a = smaller(w.z / (alpha * sin), number<F>(10));  // exp(-100) is negligible
        const F t = number<F>(1) / (number<F>(1) + number<F>(0.3275911) * a);
        const F high = number<F>(1.421413741) + t * (number<F>(-1.453152027) + t * number<F>(1.061405429));
        const F P = t * (number<F>(0.254829592) + t * (number<F>(-0.284496736) + t * high));
        const F tail = number<F>(0.56418958354775629) / a - P;
        return number<F>(2) / (number<F>(2) + exp2(a * a * number<F>(-1.4426950408889634)) * tail);
    }
};

template <class F> struct BeckmannLobe {
    static constexpr std::string_view name = "beckmann";
    static constexpr bool present = true;
    static constexpr LobeDoc manual = {.label = "Beckmann",
        .summary = "microfacets of the Beckmann distribution with roughness alpha",
        .formula = R"(\frac{D(h)\,G_1(\omega_o)\,G_1(\omega_i)}{4(n\cdot\omega_o)(n\cdot\omega_i)})",
        .parameter = LobeParameter::alpha,
        .own_arm = "beckmann-d",
        .checked_from = 1e-3};  // at alpha 3e-4 and 89 degrees its integral is known to 6e-4 only, not to the 7e-5
                                // stated
    Beckmann<F> beckmann;
    BeckmannLobe(F, F alpha) : beckmann{alpha} {}
    [[gnu::always_inline]] F operator()(Vec3<F> wo, Vec3<F> wi) const {  // (20)
        const F f = beckmann.D(normalize(wo + wi)) * beckmann.G1(wo) * beckmann.G1(wi) / (number<F>(4) * wo.z * wi.z);
        return both_above(wo, wi, f);
    }

    static double exponent(double, double alpha) { return 2 / sqr(alpha); }
    /// The half vector turns by at least half the angle of wi: exp(-49) at the reach.
    static LobeWidth width(double, double alpha) { return {2 * alpha, std::min(pi, 14 * alpha)}; }

    struct Normals {
        Beckmann<double> beckmann;
        Normals(double, double alpha) : beckmann{alpha} {}
        double height(double u) const { return 1 / std::sqrt(1 - sqr(beckmann.alpha) * math::log1p(-u)); }
        double below(double c) const { return -math::expm1((1 - 1 / (c * c)) / sqr(beckmann.alpha)); }
        double density(double c) const { return beckmann.D({std::sqrt(std::max(0.0, 1 - c * c)), 0, c}) * c; }
    };
};

}  // namespace crescent
