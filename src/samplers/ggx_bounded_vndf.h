// ggx-bounded-vndf: like ggx-vndf, on a smaller cap that contains all normals whose mirrored direction is above the
// horizon, so that fewer directions are drawn below it.
//   p = D(m) / (2 (k wo.z + t)),  t = sqrt(alpha^2 (wo.x^2 + wo.y^2) + wo.z^2);  ggx-vndf is k = 1
//   k = (1 - alpha^2) s^2 / (s^2 + alpha^2 wo.z^2),  s = 1 + sqrt(wo.x^2 + wo.y^2)
// Eto & Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX Reflections", SIGGRAPH Asia Technical Communications, eqs
// (5), (6) and (8) for one alpha <= 1. The cap's lowest z is -k (wo stretched).z instead of -(wo stretched).z.
#pragma once

#include "samplers/halfway.h"
#include "scene/lobes/ggx.h"

namespace crescent {

template <class F> struct GgxBoundedVndf {
    static constexpr std::string_view name = "ggx-bounded-vndf";
    static constexpr CaseSurface check_cases[] = {{.lobe = "ggx", .sharpness = 1}, {.lobe = "ggx", .sharpness = 0.5},
        {.lobe = "ggx", .sharpness = 0.1}, {.lobe = "ggx", .sharpness = 0.01}, {.lobe = "ggx", .sharpness = 0.001},
        {.lobe = "ggx", .sharpness = 0.3, .lambert = true}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "as ggx-vndf, without most of the normals that mirror below the horizon",
        .formula = R"(\frac{D(m)}{2(k(n\cdot\omega_o)+t)})",
        .draw = "even over a spherical cap that is cut lower down, stretched",
        .axis = "the normal $n$",
        .check_cases = check_cases,
        .gl = {1e-4, "as ggx-vndf, whose cap is cut at a height that is rounded as well"}};
    static ExpectedBehaviour theory(const CasePoint&) { return {.bounded = true}; }

    Ggx<F> ggx;
    explicit GgxBoundedVndf(const ShadingPoint<F>& shading_point) : ggx{shading_point.alpha} {}

    Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const F one = number<F>(1);
        const Vec3<F> stretched = stretched_by(ggx.alpha, wo);
        const Bound bound = bound_at(wo);
        const F height = one + bound.k * stretched.z;                           // of the cap
        const F drop = u.x * height;                                            // 1 - z on it
        const F rise = (one - u.x) * height + bound.one_minus_k * stretched.z;  // z + stretched.z
        const F sin = sqrt(larger(drop * (number<F>(2) - drop), number<F>(0)));
        const Vec3<F> m = normal_from_cap(ggx.alpha, stretched, sin, sincos_turns(u.y), rise);
        const Vec3<F> wi = mirror_about(wo, m);
        return {wi, density(wo, wi, m)};
    }
    PerSr<F> pdf(Vec3<F> wo, Vec3<F> wi) const { return density(wo, wi, halfway(wo, wi)); }

private:
    struct Bound {
        F k, one_minus_k;  // without cancellation for a small alpha
    };
    Bound bound_at(Vec3<F> wo) const {
        const F a2 = sqr(ggx.alpha), s2 = sqr(number<F>(1) + sqrt(wo.x * wo.x + wo.y * wo.y)), z2 = sqr(wo.z);
        const F inverse = number<F>(1) / (s2 + a2 * z2);
        return {(number<F>(1) - a2) * s2 * inverse, a2 * (z2 + s2) * inverse};
    }
    PerSr<F> density(Vec3<F> wo, Vec3<F> wi, Vec3<F> m) const {
        const F t = sqrt(sqr(ggx.alpha) * (wo.x * wo.x + wo.y * wo.y) + sqr(wo.z));
        const F denominator = number<F>(2) * (bound_at(wo).k * wo.z + t);
        return above(wo, wi, ggx.D(m) / larger(denominator, number<F>(1e-12)));
    }
};

}  // namespace crescent
