// beckmann-d: a Beckmann normal by the distribution D(m) (n.m), mirrored to wi.
//   tan^2 = -alpha^2 log(1 - u1), phi = 2 pi u2;  p = D(m) (n.m) / (4 (wo.m)).
// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eqs (25), (28), (29), (14). D as
// density over the drawn u1: D cos = (1 - u1) / (pi alpha^2 cos^3), which needs no second evaluation at m.
#pragma once

#include "samplers/halfway.h"
#include "scene/lobes/beckmann.h"

namespace crescent {

template <class F> struct BeckmannD {
    static constexpr std::string_view name = "beckmann-d";
    static constexpr CaseSurface check_cases[] = {{.lobe = "beckmann", .sharpness = 1},
        {.lobe = "beckmann", .sharpness = 0.5}, {.lobe = "beckmann", .sharpness = 0.1},
        {.lobe = "beckmann", .sharpness = 0.01}, {.lobe = "beckmann", .sharpness = 0.3, .lambert = true}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "a half vector by the Beckmann distribution D of roughness alpha",
        .formula = R"(\frac{D(m)\,(n\cdot m)}{4(\omega_o\cdot m)})",
        .draw = R"($\tan^2\theta_m=-\alpha^2\log(1-u_1)$)",
        .axis = "the normal $n$",
        .check_cases = check_cases,
        .gl = {2e-5, "as blinn"}};
    /// n.m is smallest for wi in the surface on w_o's side: the cosine of (theta + 90 deg) / 2. If exp(-tan^2 /
    /// alpha^2) is less than the smallest double there, p is 0 where Lambert is not.
    static ExpectedBehaviour theory(const CasePoint& point) {
        const double smallest_cos = math::cos((point.theta_deg + 90) * pi / 360);
        ExpectedBehaviour t{.bounded = point.rho_d == 0};
        if (point.rho_d > 0 && (1 / sqr(smallest_cos) - 1) / sqr(point.alpha) > 700)
            t.underflows =
                "exp(-tan^2/alpha^2) is less than the smallest number there is where Lambert is not 0: p is 0 in "
                "the arm's own arithmetic";
        return t;
    }

    Beckmann<F> beckmann;
    explicit BeckmannD(const ShadingPoint<F>& shading_point) : beckmann{shading_point.alpha} {}

    Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const F one = number<F>(1), a2 = sqr(beckmann.alpha);
        const F tan2 = -(a2 * log_one_minus(u.x));
        const F cos = one / sqrt(one + tan2), sin = cos * sqrt(tan2);
        const SinCos<F> phi = sincos_turns(u.y);
        const Vec3<F> m = {sin * phi.cos, sin * phi.sin, cos};
        const F p = (one - u.x) / (number<F>(pi) * a2 * cos * sqr(cos));
        const Vec3<F> wi = mirror_about(wo, m);
        return {wi, above(wo, wi, p / half_jacobian(dot(wo, m)))};
    }
    PerSr<F> pdf(Vec3<F> wo, Vec3<F> wi) const {
        const Vec3<F> m = halfway(wo, wi);
        return above(wo, wi, beckmann.D(m) * m.z / half_jacobian(dot(wo, m)));
    }
};

}  // namespace crescent
