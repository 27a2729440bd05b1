// Draws of a sampler against its integrals, and the tests of single draws with planted faults.
#include "check/estimate/observations.h"

#include <gtest/gtest.h>
#include <limits>

#include "check/constants.h"
#include "tests/support/power_plan.h"

namespace crescent::check {
namespace observations_test {

class CheckObservationsOfPower : public PowerPlan {};

TEST_F(CheckObservationsOfPower, BothSidesAgreeForEveryTestFunction) {
    Integrals claimed;
    Observations drawn;
    integrate(source, plan, 1u << 15, false, {1, 0, 0, 1, Purpose::points, 0}, claimed);
    observe(source, plan, {1u << 15, 1u << 15, 1u << 15}, 0, {1}, claimed, drawn);
    for (std::size_t q = 0; q < integrands; ++q) {
        const double n = drawn.independent, mean = drawn.sums[q].sum / n;
        const double v = (drawn.sums[q].square / n - mean * mean) / n + claimed.sums[q].variance;
        EXPECT_NEAR(mean, claimed.sums[q].value, 5 * std::sqrt(v) + 1e-12) << q;
    }
    EXPECT_EQ(drawn.checks.directions, 1u << 15);
    EXPECT_EQ(drawn.checks.pointwise.times + drawn.checks.zero.times + drawn.checks.invalid.times, 0u);
}

/// 4096 draws of each kind at w_o = n, with f and weights of all of them.
Observations observed(const FunctionSampler& s, const CaseLighting& light = {}) {
    Source source(s, 0, {0, 0, 1}, light);
    const Plan plan = make_plan(source, CheckBudget::limited(1e5), {});
    Integrals integrals;
    Observations out;
    integrate(source, plan, 1u << 13, true, {1, 0, 0, 1, Purpose::points, 0}, integrals);
    observe(source, plan, {1u << 12, 1u << 12, 1u << 12}, 1u << 12, {1}, integrals, out);
    return out;
}

TEST(CheckDraws, EveryFaultIsCounted) {
    FunctionSampler s;
    s.change = [](const PrimarySample& u, Draw& d) {
        if (u.x < 0.25) d.pdf *= 1.01;
        if (u.x > 0.9) d.pdf = std::numeric_limits<double>::quiet_NaN();
    };
    const DrawChecks c = observed(s).checks;
    EXPECT_EQ(c.draws, 4096u);
    EXPECT_NEAR(static_cast<double>(c.pointwise.times), 1024, 4 * 28);
    // Also of the scrambled draws, half as many because each is followed by a pdf(w) after the first fault.
    EXPECT_NEAR(static_cast<double>(c.invalid.times), 410 + 205, 4 * 25);
    EXPECT_LT(c.pointwise.first.u.x, 0.25);
    EXPECT_NEAR(c.pointwise.first.draw.pdf / c.pointwise.first.p, 1.01, 1e-9);
}

/// p depends on the length of w as at grazing angles, by 8000 times its deviation. Draws have the p of another length.
TEST(CheckDraws, ALengthThatRoundingLeavesIsNoFault) {
    FunctionSampler s;
    s.p = [](Vec3d o, Vec3d w) { return cosine_pdf(o, w) * (1 + 4e3 * (dot(w, w) - 1)); };
    const auto broken_by = [&](double deviation) {
        s.change = [&s, deviation](const PrimarySample&, Draw& d) { d.pdf = s.p({}, d.wi * (1 + deviation)); };
        return observed(s).checks.pointwise.times;
    };
    EXPECT_EQ(broken_by(1.5 * ulp), 0u);  // p off by 7e-4
    EXPECT_EQ(broken_by(-1.5 * ulp), 0u);
    EXPECT_GT(broken_by(20 * ulp), 1000u);  // of at most 1024 that are compared
}

TEST(CheckDraws, WeightsAreComparedWithFOverP) {
    FunctionSampler s;
    s.f_value = lambert(0.5);
    s.weights = [](Vec3d, Vec3d) { return Vec3d{0.5, 0, 0}; };
    EXPECT_EQ(observed(s).checks.weight.times, 0u);
    EXPECT_EQ(observed(s).checks.weights, 4096u);
    s.weights = [](Vec3d, Vec3d w) { return Vec3d{w.x > 0 ? 0.5 : 0.6, 0, 0}; };
    const DrawChecks c = observed(s).checks;
    EXPECT_NEAR(static_cast<double>(c.weight.times), 2048, 4 * 32);
    EXPECT_NEAR(c.weight.first.expected, 0.5, 1e-9);
}

TEST(CheckDraws, WithoutADirectionAreNothingAndWeightZero) {
    FunctionSampler s;
    s.f_value = lambert(0.5);
    s.draw = [](Vec3d o, const PrimarySample& u) {
        return u.y < 0.25 ? Vec3d{} : cosine_draw(o, PrimarySample(u.x, (u.y - 0.25) / 0.75));
    };
    CaseLighting light;
    light.fill = 2;
    const Observations o = observed(s, light);
    EXPECT_NEAR(static_cast<double>(o.checks.nothing), 1024, 4 * 28);
    ASSERT_EQ(o.weights.size(), 4096u);
    EXPECT_EQ(static_cast<std::uint64_t>(std::count(o.weights.begin(), o.weights.end(), 0.0)), o.checks.nothing);
    EXPECT_NEAR(*std::ranges::max_element(o.weights), 1, 1e-9);  // f L cos / p = 0.5 x 2
}

TEST(CheckDraws, BelowTheSurfaceWithoutADensityAreNothing) {
    FunctionSampler s;
    s.p = [](Vec3d, Vec3d w) { return w.z > 0 ? 1 / two_pi : 0; };
    s.draw = [](Vec3d, const PrimarySample& u) { return from_chart({1.25 * u.x, two_pi * u.y}); };
    s.change = [](const PrimarySample&, Draw& d) { d.pdf = 1 / two_pi; };
    const DrawChecks c = observed(s).checks;
    EXPECT_NEAR(static_cast<double>(c.nothing), 4096 * 0.2, 4 * 26);
    EXPECT_EQ(c.nothing + c.directions, 4096u);
    EXPECT_EQ(c.zero.times, 0u);
}

TEST(CheckDraws, RingsAndLeavesCountThem) {
    const Observations o = observed(power_sampler(1));
    double leaves = 0;
    for (const float count : o.counts) leaves += count;
    EXPECT_EQ(leaves, 4096);
    EXPECT_NEAR(o.mean_p, 4096 * 4 / (3 * two_pi), 4096 * 0.005);  // E[cos theta / pi] = 2 / (3 pi)
}

// ---- Delta parts collected from draws, and the power that they return.

Draw part(Vec3d wi, double q) {
    Draw out;
    out.wi = wi;
    out.delta = q;
    return out;
}

TEST(DeltaParts, AreTheDirectionsWithTheirProbability) {
    DeltaParts all;
    for (int k = 0; k < 10; ++k) {
        all.add(part({0, 0, 1}, 0.25), {2, 2, 2});
        all.add(part({0, 0, -1}, 0.75), {1, 1, 1});
    }
    all.add(part({0, 1e-6, 1}, 0.25), {2, 2, 2});  // equal to the rounding of a direction
    const auto& parts = all.parts(40);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].draws, 11u);
    EXPECT_EQ(parts[0].other_weights, 0u);
    EXPECT_EQ(parts[1].q, 0.75);
    EXPECT_FALSE(all.scattered());
}

TEST(DeltaParts, WithSeveralWeightsAreApartIfEachIsDrawnAsStated) {
    DeltaParts three, two;
    for (int k = 0; k < 100; ++k)
        for (const Vec3d weight : {Vec3d{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}) three.add(part({0, 0, -1}, 1 / 3.0), weight);
    EXPECT_EQ(three.parts(300).size(), 3u);
    for (int k = 0; k < 150; ++k) {
        two.add(part({0, 0, -1}, 1), {1, 1, 1});
        two.add(part({0, 0, -1}, 1), {2, 2, 2});
    }  // each half as often as q
    ASSERT_EQ(two.parts(300).size(), 1u);
    EXPECT_EQ(two.parts(300)[0].other_weights, 150u);
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
    glass.of.delta = true;
    glass.of.wo = Traits::WoDomain::both;
    glass.of.eta = Index(1.5);
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

}  // namespace observations_test
}  // namespace crescent::check
