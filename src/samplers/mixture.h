// mixture: one sample from two techniques, chosen by u1: the lobe (phong, about R) with probability q, else cosine.
//   q = min(rho_s / (rho_s + Y(rho_d)), 9/10), and 0 on a surface without a lobe;
//   p = q p_phong + (1 - q) p_cosine;  u1 in [0, q) is stretched to [0, 1) for the lobe, the rest for the cosine.
// The cosine keeps at least a tenth, so that every direction above the horizon is reached: defensive mixture,
// Hesterberg 1995, "Weighted Average Importance Sampling and Defensive Mixture Distributions".
#pragma once

#include "samplers/cosine.h"
#include "samplers/phong.h"

namespace crescent {

template <class F> struct Mixture {
    static constexpr std::string_view name = "mixture";
    static constexpr CaseSurface check_cases[] = {{.lobe = "phong", .sharpness = 32, .lambert = true},
        {.lobe = "phong", .sharpness = 32, .lambert = true, .light = "fill + disk"},
        {.lobe = "phong", .sharpness = 1000, .lambert = true}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "phong or cosine, chosen by the albedos of lobe and Lambert part",
        .formula = R"(q\,p_{\mathrm{phong}}+(1-q)\,p_{\mathrm{cosine}})",
        .draw = "phong where $u_1<q$, else cosine",
        .axis = "$R$ or $n$",
        .needs_s = true,
        .combines = true,
        .check_cases = check_cases,
        .gl = {5e-6, "as phong; the cosine part bounds 1/p"}};
    static ExpectedBehaviour theory(const CasePoint&) { return {.bounded = true}; }
    Phong<F> lobe;
    Cosine<F> diffuse;
    F q;
    explicit Mixture(const ShadingPoint<F>& shading_point) : lobe(shading_point), diffuse(shading_point) {
        const F sum = shading_point.lobe + shading_point.diffuse;
        const auto has_density = sum > number<F>(0);
        q = select(has_density, smaller(shading_point.lobe / select(has_density, sum, number<F>(1)), number<F>(0.9)),
            number<F>(0));
    }

    Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const auto of_lobe = u.x < q;
        const F stretched_u = select(of_lobe, u.x, u.x - q) / select(of_lobe, q, number<F>(1) - q);
        const Vec3<F> a = lobe.sample(wo, {stretched_u, u.y}).wi, b = diffuse.sample(wo, {stretched_u, u.y}).wi;
        const Vec3<F> wi = {select(of_lobe, a.x, b.x), select(of_lobe, a.y, b.y), select(of_lobe, a.z, b.z)};
        return {wi, pdf(wo, wi)};
    }
    PerSr<F> pdf(Vec3<F> wo, Vec3<F> wi) const {
        return {q * lobe.pdf(wo, wi).v + (number<F>(1) - q) * diffuse.pdf(wo, wi).v};
    }
};

}  // namespace crescent
