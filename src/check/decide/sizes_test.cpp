// Sizes that a right verdict may hide, and how they compare with their targets.
#include "check/decide/sizes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sampled_evidence.h"

namespace crescent::check {
namespace sizes_test {

Sizes sizes_at(const FunctionSampler& s, std::uint32_t draws, double level = 1e-5) {
    SampledEvidence e(s, {0, 0, 1}, draws);
    return sizes_of(e.source, e.evidence(), level, 2048, {1, 0, 0, 1, Purpose::pairs});
}

TEST(SizesOfFaults, AreComparedWithTheirTargets) {
    Sizes s;
    EXPECT_EQ(worst_ratio(s), 0);
    s.constant = 2 * target_constant;
    EXPECT_DOUBLE_EQ(worst_ratio(s), 2);
    s.leak = 3 * target_leak;
    EXPECT_DOUBLE_EQ(worst_ratio(s), 3);
    s.leak_change = 0.1;  // the density is nearly uniform: such a leak changes a tenth of that
    EXPECT_DOUBLE_EQ(worst_ratio(s), 2);
    s.rotation = 100 * target_rotation;
    s.rotation_change = 0;  // a rotation changes nothing
    EXPECT_DOUBLE_EQ(worst_ratio(s), 2);
    s.cap = 5 * target_cap;
    EXPECT_DOUBLE_EQ(worst_ratio(s), 5);
}

TEST(SizesOfFaults, FallWithTheDraws) {
    const Sizes few = sizes_at(power_sampler(20), 1u << 13), many = sizes_at(power_sampler(20), 1u << 17);
    ASSERT_TRUE(few.leak && many.leak && few.cap && many.cap && few.rotation && many.rotation);
    EXPECT_LT(*many.leak, 0.7 * *few.leak);
    EXPECT_LT(*many.cap, 0.7 * *few.cap);
    EXPECT_LT(*many.rotation, 0.7 * *few.rotation);
    const Sizes weaker = sizes_at(power_sampler(20), 1u << 13, 1e-2);  // a test with more false alarms
    EXPECT_LT(*weaker.parameter, 0.8 * *few.parameter);
    EXPECT_LT(*weaker.cap, *few.cap);
}

// A sharp lobe of width 1/sqrt(s) shows a smaller rotation, and a uniform leak of any lobe is nearly all outside of it.
TEST(SizesOfFaults, OfARotationFollowTheWidthOfTheLobe) {
    const Sizes wide = sizes_at(power_sampler(5), 1u << 15), sharp = sizes_at(power_sampler(500), 1u << 15);
    EXPECT_NEAR(std::log10(*wide.rotation / *sharp.rotation), 1, 0.3);  // sqrt(500 / 5) = 10
    EXPECT_NEAR(sharp.rotation_change / wide.rotation_change, 10, 4);
    EXPECT_GT(sharp.leak_change, 0.95);
    EXPECT_LT(wide.leak_change, sharp.leak_change);
}

}  // namespace sizes_test
}  // namespace crescent::check
