// Sizes that a right verdict may hide, and how they compare with their targets.
#include "check/decide/sizes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/support/sampled_evidence.h"

namespace crescent::check {
namespace sizes_test {

Sizes sizes_at(const FunctionSampler& s, std::uint32_t draws, double level = 1e-5) {
    SampledEvidence e(s, {0, 0, 1}, draws);
    return sizes_of(e.source, e.evidence(), level, 2048, {1, 0, 0, 1, Purpose::pairs});
}

FaultSize& fault(Sizes& s, std::string_view name) {
    for (std::size_t k = 0; k < s.faults.size(); ++k)
        if (fault_kinds()[k].of_directions.name == name) return s.faults[k];
    throw std::out_of_range(std::string(name));
}

TEST(SizesOfFaults, AreComparedWithTheirTargets) {
    Sizes s;
    EXPECT_EQ(worst_ratio(s), 0);
    s.faults.resize(fault_kinds().size());
    fault(s, "constant").size = 2 * target_constant;
    EXPECT_DOUBLE_EQ(worst_ratio(s), 2);
    fault(s, "leak").size = 3 * target_leak;
    EXPECT_DOUBLE_EQ(worst_ratio(s), 3);
    EXPECT_DOUBLE_EQ(worst_ratio(s, "normalised"), 2);  // of this verdict alone
    fault(s, "leak").change = 0.1;  // the density is nearly uniform: such a leak changes a tenth of that
    EXPECT_DOUBLE_EQ(worst_ratio(s), 2);
    fault(s, "rotation") = {100 * target_rotation, 0};  // a rotation changes nothing
    EXPECT_DOUBLE_EQ(worst_ratio(s), 2);
    fault(s, "cap").size = 5 * target_cap;
    EXPECT_DOUBLE_EQ(worst_ratio(s), 5);
    EXPECT_EQ(s.of("cap"), 5 * target_cap);
    EXPECT_FALSE(s.of("parameter"));
}

TEST(SizesOfFaults, FallWithTheDraws) {
    const Sizes few = sizes_at(power_sampler(20), 1u << 13), many = sizes_at(power_sampler(20), 1u << 17);
    for (const char* kind : {"leak", "cap", "rotation"}) {
        ASSERT_TRUE(few.of(kind) && many.of(kind)) << kind;
        EXPECT_LT(*many.of(kind), 0.7 * *few.of(kind)) << kind;
    }
    const Sizes weaker = sizes_at(power_sampler(20), 1u << 13, 1e-2);  // a test with more false alarms
    EXPECT_LT(weaker.of("parameter").value(), 0.8 * few.of("parameter").value());
    EXPECT_LT(weaker.of("cap").value(), few.of("cap").value());
}

// A sharp lobe of width 1/sqrt(s) shows a smaller rotation, and a uniform leak of any lobe is nearly all outside of it.
TEST(SizesOfFaults, OfARotationFollowTheWidthOfTheLobe) {
    Sizes wide = sizes_at(power_sampler(5), 1u << 15), sharp = sizes_at(power_sampler(500), 1u << 15);
    const FaultSize of_wide = fault(wide, "rotation"), of_sharp = fault(sharp, "rotation");
    EXPECT_NEAR(std::log10(of_wide.size.value() / of_sharp.size.value()), 1, 0.3);  // sqrt(500 / 5) = 10
    EXPECT_NEAR(of_sharp.change / of_wide.change, 10, 4);
    EXPECT_GT(fault(sharp, "leak").change, 0.95);
    EXPECT_LT(fault(wide, "leak").change, fault(sharp, "leak").change);
}

}  // namespace sizes_test
}  // namespace crescent::check
