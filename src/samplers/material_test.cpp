// The material's sampler is the mixture of the lobe's own sampler and the cosine by the albedos, and its weight is
// bounded on every lobe.
#include "samplers/material.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "math/simd/random.h"
#include "samplers/all.h"

namespace crescent {
namespace material_test {

ShadingPoint<double> point_on(LobeKind lobe, double rho_d, double rho_s) {
    ShadingPoint<double> out{};
    out.wo = normalize(Vec3d{0.6, -0.3, 0.5});
    out.s = 32;
    out.alpha = 0.2;
    out.diffuse = rho_d;
    out.lobe = rho_s;
    out.lobe_kind = lobe;
    return out;
}

double density_of(std::string_view sampler, const ShadingPoint<double>& point, Vec3d wi) {
    double out = -1;
    for_each_sampler(Samplers{}, [&]<template <class> class A>() {
        if constexpr (DrawsOne<A<double>, double>)
            if (A<double>::name == sampler) out = A<double>(point).pdf(point.wo, wi).v;
    });
    return out;
}

TEST(Material, MixesTheLobesOwnSamplerWithTheCosineByAlbedo) {
    for (const LobeInfo& lobe : lobe_infos()) {
        const ShadingPoint<double> point = point_on(lobe.kind, 0.3, 0.1);
        const MaterialSampler<double> sampler(point);
        double largest = 0;
        for (std::uint32_t k = 0; k < 4096; ++k) {
            const Vec2<float> u = draw(1, k, 0);
            const Drawn<double> drawn = sampler.sample(point.wo, {double(u.x), double(u.y)});
            const double own = density_of(lobe.own_arm, point, drawn.wi), even = density_of("cosine", point, drawn.wi);
            EXPECT_NEAR(drawn.pdf.v, 0.25 * own + 0.75 * even, 1e-12 * drawn.pdf.v) << lobe.name;
            if (!(drawn.wi.z > 0)) continue;
            const double f = 0.3 / pi + 0.1 * lobe_value(lobe.kind, point.s, point.alpha, point.wo, drawn.wi);
            largest = std::max(largest, f * drawn.wi.z / drawn.pdf.v);
        }
        EXPECT_GT(largest, 0.3) << lobe.name;
        EXPECT_LT(largest, 1.0) << lobe.name;
    }
}

TEST(Material, IsTheCosineOnLambertAndTheLobeAloneWithoutIt) {
    const ShadingPoint<double> lambert = point_on(LobeKind::none, 0.5, 0), ggx = point_on(lobe_named("ggx"), 0, 0.5);
    for (std::uint32_t k = 0; k < 64; ++k) {
        const Vec2<float> u = draw(2, k, 0);
        const Vec2<double> at{double(u.x), double(u.y)};
        EXPECT_EQ(MaterialSampler<double>(lambert).sample(lambert.wo, at).wi.x,
            Cosine<double>(lambert).sample(lambert.wo, at).wi.x);
        EXPECT_EQ(MaterialSampler<double>(ggx).sample(ggx.wo, at).wi.x, GgxVndf<double>(ggx).sample(ggx.wo, at).wi.x);
    }
}

}  // namespace material_test
}  // namespace crescent
