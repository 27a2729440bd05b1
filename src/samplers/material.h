// material: one sample from the sampler of the surface's own lobe or from the cosine, chosen by the albedos.
//   q = rho_s / (rho_s + Y(rho_d)), and 0 on a surface without a lobe;
//   p = q p_lobe + (1 - q) p_cosine;  u1 in [0, q) is stretched to [0, 1) for the lobe, the rest for the cosine.
// f cos / p <= (rho_s + Y(rho_d)) max(1, w), w being the largest lobe cos / p_lobe: no share needs a limit. The sampler
// of a lobe is its `own_arm` (scene/lobes/lobe.h). Pharr, Jakob & Humphreys 2016, "Physically Based Rendering", 14.1.6,
// with shares in proportion to the albedos.
#pragma once

#include <tuple>

#include "samplers/beckmann_d.h"
#include "samplers/blinn.h"
#include "samplers/cosine.h"
#include "samplers/ggx_vndf.h"
#include "samplers/phong.h"
#include "scene/lobes/all.h"

namespace crescent {

template <class F> struct MaterialSampler {
    static constexpr std::string_view name = "material";
    static constexpr CaseSurface check_cases[] = {{.lambert = true},
        {.lobe = "phong", .sharpness = 32, .lambert = true}, {.lobe = "blinn-phong", .sharpness = 32, .lambert = true},
        {.lobe = "ggx", .sharpness = 0.1, .lambert = true}, {.lobe = "beckmann", .sharpness = 0.3, .lambert = true},
        {.lobe = "ggx", .sharpness = 0.3}, {.lobe = "ggx", .sharpness = 0.3, .lambert = true, .light = "fill + disk"}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "the sampler of the surface's own lobe or the cosine, chosen by their albedos",
        .formula = R"(q\,p_{\mathrm{lobe}}+(1-q)\,p_{\mathrm{cosine}})",
        .draw = "the lobe's own sampler where $u_1<q$, else cosine",
        .axis = "the normal $n$",
        .combines = true,
        .check_cases = check_cases};
    static ExpectedBehaviour theory(const CasePoint&) { return {.bounded = true}; }

    std::tuple<Phong<F>, Blinn<F>, GgxVndf<F>, BeckmannD<F>> of_lobes;
    Cosine<F> diffuse;
    LobeKind lobe;
    F q;

    explicit MaterialSampler(const ShadingPoint<F>& point)
        : of_lobes(Phong<F>(point), Blinn<F>(point), GgxVndf<F>(point), BeckmannD<F>(point)),
          diffuse(point),
          lobe(point.lobe_kind) {
        const F sum = point.lobe + point.diffuse;
        const auto has_density = sum > number<F>(0);
        q = lobe == LobeKind::none
            ? number<F>(0)
            : select(has_density, point.lobe / select(has_density, sum, number<F>(1)), number<F>(0));
    }

    Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        if (lobe == LobeKind::none) return diffuse.sample(wo, u);
        const auto of_lobe = u.x < q;
        const F share = select(of_lobe, q, number<F>(1) - q);
        const F stretched_u = select(of_lobe, u.x, u.x - q) / share;
        const Vec3<F> a = sample_lobe(wo, {stretched_u, u.y}), b = diffuse.sample(wo, {stretched_u, u.y}).wi;
        const Vec3<F> wi = {select(of_lobe, a.x, b.x), select(of_lobe, a.y, b.y), select(of_lobe, a.z, b.z)};
        return {wi, pdf(wo, wi)};
    }
    PerSr<F> pdf(Vec3<F> wo, Vec3<F> wi) const {
        if (lobe == LobeKind::none) return diffuse.pdf(wo, wi);
        return {q * lobe_pdf(wo, wi) + (number<F>(1) - q) * diffuse.pdf(wo, wi).v};
    }

private:
    /// The index in of_lobes of the sampler that a lobe names.
    template <template <class> class L> static constexpr std::size_t own_sampler() {
        return [&]<std::size_t... k>(std::index_sequence<k...>) {
            std::size_t match = sizeof...(k);
            ((std::tuple_element_t<k, decltype(of_lobes)>::name == L<F>::manual.own_arm ? void(match = k) : void()),
                ...);
            return match;
        }(std::make_index_sequence<std::tuple_size_v<decltype(of_lobes)>>{});
    }
    [[gnu::noinline]] Vec3<F> sample_lobe(Vec3<F> wo, Vec2<F> u) const {
        Vec3<F> out = wo;
        with_lobe(
            lobe, [&]<template <class> class L>() { out = std::get<own_sampler<L>()>(of_lobes).sample(wo, u).wi; });
        return out;
    }
    [[gnu::noinline]] F lobe_pdf(Vec3<F> wo, Vec3<F> wi) const {
        F out = number<F>(0);
        with_lobe(lobe, [&]<template <class> class L>() { out = std::get<own_sampler<L>()>(of_lobes).pdf(wo, wi).v; });
        return out;
    }
};

}  // namespace crescent
