// Two-sample multiple importance sampling: one direction from the BRDF's mixture, one from the lights (by area), both
// added, each weighted by the densities of both techniques.
//   X = w_1 f L cos / p_1 + w_2 f L cos / p_2,  w_1 + w_2 = 1 wherever p_1 + p_2 > 0.
// Veach & Guibas 1995, "Optimally Combining Sampling Techniques for Monte Carlo Rendering": one sample from each. N
// counts pairs.
#pragma once

#include "samplers/light_area.h"
#include "samplers/mixture.h"

namespace crescent {

inline constexpr CaseSurface mis_cases[] = {{.lobe = "phong", .sharpness = 32, .lambert = true},
    {.lobe = "phong", .sharpness = 32, .lambert = true, .light = "fill + disk"},
    {.lobe = "phong", .sharpness = 1000, .lambert = true},
    {.lobe = "phong", .sharpness = 32, .lambert = true, .light = "fill + two disks"}};

/// `Heuristic::weight(this_pdf, other)` of two densities in 1/sr, this_pdf > 0.
template <class F, class Heuristic> struct TwoSampleMis {
    static constexpr int techniques = 2;
    Mixture<F> brdf;
    LightArea<F> light;
    explicit TwoSampleMis(const ShadingPoint<F>& shading_point) : brdf(shading_point), light(shading_point) {}

    template <int t> auto sample_technique(Vec3<F> wo, Vec2<F> u) const {
        if constexpr (t == 0) return brdf.sample(wo, u);
        else return light.sample(wo, u);
    }
    template <int t> PerSr<F> pdf_technique(Vec3<F> wo, Vec3<F> wi) const {
        if constexpr (t == 0) return brdf.pdf(wo, wi);
        else return light.pdf(wo, wi);
    }
    template <int t> F weight(Vec3<F> wo, Drawn<F> draw) const {
        return Heuristic::weight(draw.pdf.v, pdf_technique<1 - t>(wo, draw.wi).v);
    }
};

// ---- mis-balance: BRDF mixture and light by area, two samples, balance heuristic.
//   w_i = p_i / (p_1 + p_2)      Veach & Guibas 1995, eq. (11) with one sample from each.

struct BalanceHeuristic {
    /// 1 / (1 + other/this_pdf): no overflow for large densities; this_pdf = 0 was not drawn and has weight 0.
    template <class F> static F weight(F this_pdf, F other) {
        const auto is_drawn = this_pdf > number<F>(0);
        return select(
            is_drawn, number<F>(1) / (number<F>(1) + other / select(is_drawn, this_pdf, number<F>(1))), number<F>(0));
    }
};

template <class F> struct MisBalance : TwoSampleMis<F, BalanceHeuristic> {
    static constexpr std::string_view name = "mis-balance";
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "mixture and light-area, a direction of each, weighed by the balance heuristic",
        .formula = R"(w_i=\frac{p_i}{p_1+p_2})",
        .density = R"(p_1,p_2)",
        .draw = "a direction by mixture and one by light-area, balance heuristic",
        .axis = "both",
        .needs_s = true,
        .combines = true,
        .check_cases = mis_cases,
        .gl = {5e-6, "as mixture; weights are at most 1"}};
    static ExpectedBehaviour theory(const CasePoint&) { return {.bounded = true}; }
    using TwoSampleMis<F, BalanceHeuristic>::TwoSampleMis;
};

// ---- mis-power: BRDF mixture and light by area, two samples, power heuristic.
//   w_i = p_i^2 / (p_1^2 + p_2^2)      Veach & Guibas 1995, eq. (13) with beta = 2.

struct PowerHeuristic {
    template <class F> static F weight(F this_pdf, F other) {
        const auto is_drawn = this_pdf > number<F>(0);
        return select(is_drawn, number<F>(1) / (number<F>(1) + sqr(other / select(is_drawn, this_pdf, number<F>(1)))),
            number<F>(0));
    }
};

template <class F> struct MisPower : TwoSampleMis<F, PowerHeuristic> {
    static constexpr std::string_view name = "mis-power";
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "mixture and light-area, a direction of each, weighed by the power heuristic",
        .formula = R"(w_i=\frac{p_i^2}{p_1^2+p_2^2})",
        .density = R"(p_1,p_2)",
        .draw = "a direction by mixture and one by light-area, power heuristic",
        .axis = "both",
        .needs_s = true,
        .combines = true,
        .check_cases = mis_cases,
        .gl = {5e-6, "as mixture; weights are at most 1"}};
    static ExpectedBehaviour theory(const CasePoint&) { return {.bounded = true}; }
    using TwoSampleMis<F, PowerHeuristic>::TwoSampleMis;
};

}  // namespace crescent
