// blinn: a cosine-power half-vector about n, mirrored to wi.
//   p_m = (s+1)/(2 pi) (n.m)^s;  cos = u1^(1/(s+1)), phi = 2 pi u2;  p = p_m / (4 (wo.m)).
// Blinn 1977, "Models of Light Reflection for Computer Synthesized Pictures", sampled as in Walter et al. 2007, eq.
// (14).
#pragma once

#include "samplers/halfway.h"

namespace crescent {

template <class F> struct Blinn {
    static constexpr std::string_view name = "blinn";
    static constexpr CaseSurface check_cases[] = {{.lobe = "blinn-phong", .sharpness = 8},
        {.lobe = "blinn-phong", .sharpness = 32}, {.lobe = "blinn-phong", .sharpness = 128},
        {.lobe = "blinn-phong", .sharpness = 1e4}, {.lobe = "blinn-phong", .sharpness = 1e5},
        {.lobe = "blinn-phong", .sharpness = 32, .lambert = true}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "a half vector by a cosine power of exponent s about the normal",
        .formula = R"(\frac{s+1}{2\pi}\,\frac{(n\cdot m)^s}{4(\omega_o\cdot m)})",
        .draw = R"($\cos\theta_m=u_1^{1/(s+1)}$)",
        .axis = "the normal $n$",
        .needs_s = true,
        .check_cases = check_cases,
        .gl = {2e-5, "p has 1/(wo.m), and the mirrored wi doubles m's error"}};
    /// n.h is smallest for wi in the surface on w_o's side: the cosine of (theta + 90 deg) / 2.
    static ExpectedBehaviour theory(const CasePoint& point) {
        const double smallest_cos = math::cos((point.theta_deg + 90) * pi / 360);
        return {.bounded = point.rho_d == 0, .underflows = power_underflows(point, smallest_cos)};
    }
    F s, inverse, scale;
    explicit Blinn(const ShadingPoint<F>& shading_point)
        : s(shading_point.s),
          inverse(number<F>(1) / (shading_point.s + number<F>(1))),
          scale((shading_point.s + number<F>(1)) * number<F>(0.5 / pi)) {}

    Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const Power<F> root = power(u.x, inverse);
        const F cos = root.value;
        const F sin = sqrt(root.one_minus * (number<F>(1) + cos));
        const SinCos<F> phi = sincos_turns(u.y);
        const Vec3<F> m = {sin * phi.cos, sin * phi.sin, cos};
        const F p = scale * (u.x / cos) / half_jacobian(dot(wo, m));
        const Vec3<F> wi = mirror_about(wo, m);
        return {wi, above(wo, wi, select(u.x > number<F>(0), p, number<F>(0)))};
    }
    PerSr<F> pdf(Vec3<F> wo, Vec3<F> wi) const {
        const Vec3<F> m = halfway(wo, wi);
        return above(wo, wi,
            scale * cosine_power(m, Vec3<F>{number<F>(0), number<F>(0), number<F>(1)}, s) / half_jacobian(dot(wo, m)));
    }
};

}  // namespace crescent
