// ggx-d: a GGX normal by the distribution D(m) (n.m), mirrored to wi.
//   tan^2 = alpha^2 u1 / (1 - u1), phi = 2 pi u2;  p = D(m) (n.m) / (4 (wo.m)).
// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eqs (33), (35), (36), (14). D as
// density over the drawn u1: D cos = (1 - u1 + alpha^2 u1)^2 cos / (pi alpha^2), which needs no second evaluation at m.
#pragma once

#include "samplers/halfway.h"
#include "scene/lobes/ggx.h"

namespace crescent {

template <class F> struct GgxD {
    static constexpr std::string_view name = "ggx-d";
    static constexpr CaseSurface check_cases[] = {{.lobe = "ggx", .sharpness = 0.5}, {.lobe = "ggx", .sharpness = 0.1},
        {.lobe = "ggx", .sharpness = 0.01}, {.lobe = "ggx", .sharpness = 0.001},
        {.lobe = "ggx", .sharpness = 0.3, .lambert = true}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "a half vector by the GGX distribution D of roughness alpha",
        .formula = R"(\frac{D(m)\,(n\cdot m)}{4(\omega_o\cdot m)})",
        .draw = R"($\tan^2\theta_m=\frac{\alpha^2u_1}{1-u_1}$)",
        .axis = "the normal $n$",
        .check_cases = check_cases,
        .gl = {2e-5, "as blinn"}};
    static ExpectedBehaviour theory(const CasePoint& point) { return {.bounded = point.rho_d == 0}; }
    Ggx<F> ggx;
    explicit GgxD(const ShadingPoint<F>& shading_point) : ggx{shading_point.alpha} {}

    Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const F one = number<F>(1), a2 = sqr(ggx.alpha);
        const F t = (one - u.x) + a2 * u.x;  // cos^2 = (1 - u)/t, sin^2 = alpha^2 u / t
        const F cos = sqrt((one - u.x) / t), sin = ggx.alpha * sqrt(u.x / t);
        const SinCos<F> phi = sincos_turns(u.y);
        const Vec3<F> m = {sin * phi.cos, sin * phi.sin, cos};
        const F p = sqr(t) * cos / (number<F>(pi) * a2);
        const Vec3<F> wi = mirror_about(wo, m);
        return {wi, above(wo, wi, p / half_jacobian(dot(wo, m)))};
    }
    PerSr<F> pdf(Vec3<F> wo, Vec3<F> wi) const {
        const Vec3<F> m = halfway(wo, wi);
        return above(wo, wi, ggx.D(m) * m.z / half_jacobian(dot(wo, m)));
    }
};

}  // namespace crescent
