// The difference that a repetition of a test finds, and the renders that it needs, in closed form.
#include "compare/suite/render_plan.h"

#include <gtest/gtest.h>

#include <cmath>

namespace crescent {
namespace render_plan_test {

constexpr double z90 = 1.2815515655446004;

TEST(RenderPower, PowerFollowsTheNumberOfRenders) {
    RegionPower power{1, 0.01, 0.01, 1e9, false, 0};
    const auto n = renders_needed(power, 0.05, 0.01);
    ASSERT_TRUE(n);
    EXPECT_LE(detectable_with(power, *n, 0.01), 0.05);
    EXPECT_GT(detectable_with(power, *n - 1, 0.01), 0.05);
    EXPECT_FALSE(renders_needed(power, 1e-9, 0.01));
    // n equal groups: t quantiles of many degrees of freedom are those of the normal distribution.
    const double z = 2.5758 + 1.2816;
    EXPECT_NEAR(detectable_with(power, 10000, 0.01), z * std::sqrt(2 * 0.01 / 10000), 1e-6);
}

TEST(RenderPower, AnEstimatedErrorNeedsALargerDifference) {
    Welch test;
    test.se = 2;
    test.df = 14;
    const double known = found_difference(test, 1e12, 0.01), estimated = found_difference(test, 14, 0.01);
    // Normal approximation of s: c = t m2 + z sqrt(1 + t^2 / (2 df)), with t(14) = 2.9768 at 1 %.
    const double t = 2.97684, m2 = 1 - 1.0 / 56;
    EXPECT_NEAR(known, 2 * (t * m2 + z90 * std::sqrt(1 + t * t / 28)), 2e-4);
    EXPECT_GT(estimated, 1.1 * known);
    EXPECT_LT(estimated, 1.4 * known);
    // The result solves c m1 - t m2 = z sqrt(1 + c^2 / (2 df1) + t^2 / (2 df2)).
    const double c = estimated / 2, m1 = 1 - 1.0 / 56;
    EXPECT_NEAR(c * m1 - t * m2, z90 * std::sqrt(1 + c * c / 28 + t * t / 28), 1e-4);
    EXPECT_EQ(found_difference(test, 0.5, 0.01), HUGE_VAL);  // too few degrees of freedom
}

TEST(RenderPower, OfPairsIsThatOfOneSideOfDifferences) {
    const RegionPower apart{1, 0.5, 0.5, 1e9, false, 0}, paired{1, 1, 0, 1e9, true, 0};
    EXPECT_NEAR(detectable_with(paired, 5000, 0.01) / detectable_with(apart, 5000, 0.01), 1, 1e-3);
    EXPECT_GT(detectable_with(paired, 4, 0.01), 1.5 * detectable_with(apart, 4, 0.01));  // 3 and 6 degrees of freedom
}

TEST(RenderPower, RareEventsFallAsOneOverTheRenders) {
    RegionPower power{1, 1e-9, 1e-9, 1e9};
    power.hidden_difference = 8;
    EXPECT_DOUBLE_EQ(detectable_with(power, 100, 0.01), 0.08);
    EXPECT_EQ(renders_needed(power, 0.05, 0.01), 160u);
    EXPECT_FALSE(renders_needed({0, 1, 1, 1e9, false, 0}, 0.05, 0.01));  // relative to a mean of 0
}

}  // namespace render_plan_test
}  // namespace crescent
