// Draws of two samplers on one tree: what the test of one distribution finds, and what it states to find.
#include "check/against_draws.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace against_draws_test {

/// Both samplers at w_o = n with draws of one look.
struct Two {
    Two(const FunctionSampler& of_a, const FunctionSampler& of_b) : first(of_a), second(of_b) {
        case_a.wo = case_b.wo = {0, 0, 1};
        const AgainstSide a{case_a, second, {1, 0, 0, 1}}, b{case_b, first, {1, 1, 0, 1}};
        case_a.adapter = std::make_shared<FunctionSampler>(first);
        case_b.adapter = std::make_shared<FunctionSampler>(second);
        common.emplace(common_tree(a, b, CheckBudget::limited(2e5)));
        draw_on(a, *common, {0, 1u << 15, 1u << 15}, 1u << 12, of_first);
        draw_on(b, *common, {0, 1u << 15, 1u << 15}, 1u << 12, of_second);
    }
    /// The least p of each family times its members.
    std::map<AgainstAnswer::Family, double> p() const {
        std::map<AgainstAnswer::Family, double> least, members;
        test_against(*common, of_first, of_second, [&](const AgainstAnswer& a) {
            least.try_emplace(a.family, 1);
            ++members[a.family];
            least[a.family] = std::min(least[a.family], a.p);
        });
        for (auto& [family, p] : least) p = std::min(1.0, p * members[family]);
        return least;
    }
    FunctionSampler first, second;
    CheckCase case_a, case_b;
    std::optional<CommonTree> common;
    AgainstDraws of_first, of_second;
};

TEST(DrawsOfTwo, OfOneDistributionPassEveryFamily) {
    const Two two({}, {});
    EXPECT_EQ(two.of_first.independent, 1u << 15);
    EXPECT_EQ(two.p().size(), static_cast<std::size_t>(AgainstAnswer::families));
    for (const auto& [family, p] : two.p()) EXPECT_GT(p, 1e-3) << name_of(family);
}

TEST(DrawsOfTwo, AnotherPowerIsFoundByNodesAndSums) {
    const Two two({}, power_sampler(1.3));
    std::map<AgainstAnswer::Family, double> p = two.p();
    EXPECT_LT(p[AgainstAnswer::sums], 1e-8);
    EXPECT_LT(p[AgainstAnswer::sums_by_sets], 1e-8);
    EXPECT_LT(p[AgainstAnswer::nodes], 1e-8);
    EXPECT_GT(p[AgainstAnswer::kinds], 1e-3);
}

TEST(DrawsOfTwo, AShareWithoutASampleIsAKind) {
    FunctionSampler some;
    some.draw = [](Vec3d o, const PrimarySample& u) {
        return u.y < 0.02 ? Vec3d{} : cosine_draw(o, PrimarySample(u.x, (u.y - 0.02) / 0.98));
    };
    EXPECT_LT(Two({}, some).p()[AgainstAnswer::kinds], 1e-8);
}

TEST(DrawsOfTwo, StatedSizesFallWithTheDraws) {
    Two two({}, {});
    const AgainstSizes sizes = sizes_against(*two.common, two.of_first, two.of_second, 1e-5);
    ASSERT_TRUE(sizes.part && sizes.distance);
    // A mean of 2^15 draws on both sides: sd of x 1/2, at 1e-5 and 90 % about 4.4 + 1.3 or 2 of its errors.
    const double error = 0.5 * std::sqrt(2.0 / (1u << 15));
    EXPECT_LT(*sizes.distance, 8 * error);
    EXPECT_GT(*sizes.distance, error / 50);  // replicates are sharper
    EXPECT_LT(*sizes.part, 0.05);
    EXPECT_GT(*sizes.part, 1e-4);
    EXPECT_LT(*sizes.part, *sizes_against(*two.common, two.of_first, two.of_second, 1e-12).part);
}

}  // namespace against_draws_test
}  // namespace crescent::check
