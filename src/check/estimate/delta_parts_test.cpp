// Delta parts collected from draws, and the power that they return.
#include "check/estimate/delta_parts.h"

#include <gtest/gtest.h>

#include "check/constants.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace {

Draw part(Vec3d wi, double q) {
    Draw out;
    out.wi = wi, out.delta = q;
    return out;
}

TEST(DeltaParts, AreTheDirectionsWithTheirProbability) {
    DeltaParts all;
    for (int k = 0; k < 10; ++k) all.add(part({0, 0, 1}, 0.25), {2, 2, 2}), all.add(part({0, 0, -1}, 0.75), {1, 1, 1});
    all.add(part({0, 1e-6, 1}, 0.25), {2, 2, 2});  // equal to the rounding of a direction
    const auto& parts = all.parts(40);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].drawn, 11u);
    EXPECT_EQ(parts[0].otherwise, 0u);
    EXPECT_EQ(parts[1].q, 0.75);
    EXPECT_FALSE(all.scattered());
}

TEST(DeltaParts, WithSeveralWeightsAreApartIfEachIsDrawnAsStated) {
    DeltaParts three, two;
    for (int k = 0; k < 100; ++k)
        for (const Vec3d weight : {Vec3d{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}) three.add(part({0, 0, -1}, 1 / 3.0), weight);
    EXPECT_EQ(three.parts(300).size(), 3u);
    for (int k = 0; k < 150; ++k)
        two.add(part({0, 0, -1}, 1), {1, 1, 1}), two.add(part({0, 0, -1}, 1), {2, 2, 2});  // each half as often as q
    ASSERT_EQ(two.parts(300).size(), 1u);
    EXPECT_EQ(two.parts(300)[0].otherwise, 150u);
}

TEST(DeltaParts, OfManyDirectionsAreScattered) {
    DeltaParts all;
    for (std::size_t k = 0; k < most_delta_parts; ++k) all.add(part(tilt(static_cast<double>(k)), 0.05), {});
    EXPECT_FALSE(all.scattered());
    all.add(part(tilt(80), 0.05), {});
    EXPECT_TRUE(all.scattered());
}

TEST(DeltaFlux, IsScaledByTheIndexAcrossTheSurface) {
    FunctionSampler glass;
    glass.of.delta = true, glass.of.wo = Traits::WoDomain::both, glass.of.eta = Index(1.5);
    const CaseLighting light;
    const Vec3d wo = tilt(40), refracted = tilt(180 - 25.4, 180);
    const auto flux = [&](Vec3d from, const std::vector<DeltaPart>& parts) {
        Source source(glass, 0, from, light);
        return delta_flux(source, parts)[0];
    };
    EXPECT_NEAR(flux(wo, {{mirror(wo), 0.5, {0.4, 0, 0}, 1, 0}}), 0.2, 1e-12);
    EXPECT_NEAR(flux(wo, {{refracted, 0.5, {0.4, 0, 0}, 1, 0}}), 0.2 * 2.25, 1e-12);
    EXPECT_NEAR(flux(-wo, {{-refracted, 0.5, {0.4, 0, 0}, 1, 0}}), 0.2 / 2.25, 1e-12);
    EXPECT_NEAR(flux(wo, {{-wo, 0.5, {0.4, 0, 0}, 1, 0}}), 0.2, 1e-12);  // a hole is not scaled
}

}  // namespace
}  // namespace crescent::check
