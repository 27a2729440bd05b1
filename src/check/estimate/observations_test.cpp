// Draws of a sampler against its integrals, and the tests of single draws with planted faults.
#include "check/estimate/observations.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace {

class CheckObservationsOfPower : public testing::Test {
protected:
    FunctionSampler sampler = power_sampler(40);
    CaseLighting light;
    Source source{sampler, 0, {0, 0, 1}, light};
    CheckBudget budget = CheckBudget::limited();
    Plan plan = make_plan(source, budget, {});
};

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
    EXPECT_EQ(c.tested, 4096u);
    EXPECT_NEAR(static_cast<double>(c.pointwise.times), 1024, 4 * 28);
    // Also of the scrambled draws, half as many because each is followed by a pdf(w) after the first fault.
    EXPECT_NEAR(static_cast<double>(c.invalid.times), 410 + 205, 4 * 25);
    EXPECT_LT(c.pointwise.first.u.x, 0.25);
    EXPECT_NEAR(c.pointwise.first.draw.pdf / c.pointwise.first.p, 1.01, 1e-9);
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

TEST(CheckDraws, RingsAndLeavesCountThem) {
    const Observations o = observed(power_sampler(1));
    double leaves = 0;
    for (const float count : o.counts) leaves += count;
    EXPECT_EQ(leaves, 4096);
    EXPECT_NEAR(o.mean_p, 4096 * 4 / (3 * two_pi), 4096 * 0.005);  // E[cos theta / pi] = 2 / (3 pi)
}

}  // namespace
}  // namespace crescent::check
