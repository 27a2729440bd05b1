// Two-sample multiple importance sampling: one direction from the BRDF's mixture, one from the lights (by area), both
// added, each weighed by what the other technique would have done there.
//   X = w_1 f L cos / p_1 + w_2 f L cos / p_2,  w_1 + w_2 = 1 wherever p_1 + p_2 > 0.
// Veach & Guibas 1995, "Optimally Combining Sampling Techniques for Monte Carlo Rendering": one sample from each.
// N counts pairs.
#pragma once

#include "arms/light_area.h"
#include "arms/mixture.h"

namespace crescent::inline arms {

inline constexpr TrialSurface mis_trials[] = {{.lobe = "phong", .sharpness = 32, .lambert = true},
    {.lobe = "phong", .sharpness = 32, .lambert = true, .light = "fill + disk"},
    {.lobe = "phong", .sharpness = 1000, .lambert = true},
    {.lobe = "phong", .sharpness = 32, .lambert = true, .light = "fill + two disks"}};

/// `Heuristic::weight(own, other)` of two densities in 1/sr, own > 0.
template <class F, class Heuristic> struct TwoSampleMis {
    static constexpr int techniques = 2;
    Mixture<F> brdf;
    LightArea<F> light;
    explicit TwoSampleMis(const ShadingPoint<F>& site) : brdf(site), light(site) {}

    template <int t> auto sample_technique(Vec3<F> wo, Vec2<F> u) const {
        if constexpr (t == 0) return brdf.sample(wo, u);
        else return light.sample(wo, u);
    }
    template <int t> PerSr<F> pdf_technique(Vec3<F> wo, Vec3<F> wi) const {
        if constexpr (t == 0) return brdf.pdf(wo, wi);
        else return light.pdf(wo, wi);
    }
    template <int t> F weight(Vec3<F> wo, Drawn<F> drawn) const {
        return Heuristic::weight(drawn.pdf.v, pdf_technique<1 - t>(wo, drawn.wi).v);
    }
};

}  // namespace crescent::inline arms
