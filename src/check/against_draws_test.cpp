// Draws of two samplers on one plan: what the test of one distribution finds, and what it states to find.
#include "check/against_draws.h"

#include <gtest/gtest.h>

#include <map>

#include "check/decide/sizes.h"
#include "check/verdicts/density.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace against_draws_test {

/// Both samplers at w_o = n with draws of one look.
struct Two {
    Two(const FunctionSampler& of_a, const FunctionSampler& of_b, std::uint32_t draws = 1u << 15)
        : first(of_a), second(of_b) {
        case_a.wo = case_b.wo = {0, 0, 1};
        const AgainstSide a{case_a, second, {1, 0, 0, 1}}, b{case_b, first, {1, 1, 0, 1}};
        case_a.adapter = std::make_shared<FunctionSampler>(first);
        case_b.adapter = std::make_shared<FunctionSampler>(second);
        common.emplace(common_plan(a, b, CheckBudget::limited(2e5)));
        draw_on(a, *common, {0, draws, draws}, 1u << 12, of_first);
        draw_on(b, *common, {0, draws, draws}, 1u << 12, of_second);
        both.emplace(a, *common, of_first, of_second);
    }
    Two(const Two&) = delete;
    Two& operator=(const Two&) = delete;

    /// The least p of each family times its members.
    std::map<Family, double> p() const {
        std::map<Family, double> out;
        for (const auto& [family, least] : least_by_family<Answer>(both->tests())) out[family] = least.p();
        return out;
    }
    FunctionSampler first, second;
    CheckCase case_a, case_b;
    std::optional<CommonPlan> common;
    SamplerDraws of_first, of_second;
    std::optional<AgainstEvidence> both;
};

TEST(DrawsOfTwo, OfOneDistributionPassEveryFamily) {
    const Two two({}, {});
    EXPECT_EQ(two.of_first.total.independent, 1u << 15);
    const std::map<Family, double> p = two.p();
    for (Family f : {Family::mass, Family::slope_sets, Family::centre, Family::node, Family::node_sets, Family::band,
             Family::depth})
        EXPECT_TRUE(p.contains(f)) << info(f).name;
    for (const auto& [family, least] : p) EXPECT_GT(least, 1e-3) << info(family).name;
}

TEST(DrawsOfTwo, AnotherPowerIsFoundByNodesAndSums) {
    const Two two({}, power_sampler(1.3));
    std::map<Family, double> p = two.p();
    for (Family f : {Family::slope, Family::slope_sets, Family::centre, Family::centre_sets, Family::node,
             Family::node_sets, Family::band, Family::depth})
        EXPECT_LT(p[f], 1e-8) << info(f).name;
    EXPECT_GT(p[Family::mass], 1e-3);
}

TEST(DrawsOfTwo, AShareWithoutASampleIsFoundByTheMass) {
    FunctionSampler some;
    some.draw = [](Vec3d o, const PrimarySample& u) {
        return u.y < 0.02 ? Vec3d{} : cosine_draw(o, PrimarySample(u.x, (u.y - 0.02) / 0.98));
    };
    const Two two({}, some), exchanged(some, {});
    EXPECT_LT(two.p()[Family::mass], 1e-8);
    EXPECT_LT(exchanged.p()[Family::mass], 1e-8);
}

// k of n draws and m of n draws: the difference of two shares, of variance p (1 - p) 2 / n if p is that of both.
TEST(DrawsOfTwo, HaveTheVarianceOfADifferenceOfShares) {
    constexpr std::uint32_t draws = 1u << 14;
    const Two two({}, {}, draws);
    const Evidence e = two.both->evidence();
    const std::vector<NodeSums> sums = node_sums(e);
    const NodeSplit s = split_of(e, sums, 0);  // all draws
    const TreeNode& root = e.plan.tree.nodes()[0];
    const auto half_of = [&](const SamplerDraws& d) {
        double out = 0;
        for (std::size_t l = 0; l < e.plan.tree.leaves().size(); ++l) {
            const ChartPoint middle = e.plan.tree.rect(e.plan.tree.leaves()[l]).at(0.5, 0.5);
            const double place = root.along_phi ? middle.phi : middle.t;
            if (place < root.rect.middle(root.along_phi)) out += static_cast<double>(d.total.counts[l]);
        }
        return out / draws;
    };
    const double a = half_of(two.of_first), b = half_of(two.of_second), p = (a + b) / 2, h = 0.5;
    EXPECT_DOUBLE_EQ(s.visible, 0.5);
    EXPECT_NEAR(s.difference / s.visible / h, a - b, 1e-12);
    EXPECT_NEAR(s.variance / sqr(s.visible * h), p * (1 - p) * 2 / draws, 1e-12);
}

TEST(DrawsOfTwo, StatedSizesFallWithTheDraws) {
    const Two two({}, {});
    const auto sizes_at = [&](double level) {
        return sizes_between(two.both->evidence(), level, two.common->directions);
    };
    const DifferenceSizes sizes = sizes_at(1e-5);
    ASSERT_TRUE(sizes.part && sizes.distance);
    // A mean of 2^15 draws on both sides: sd of x 1/2, at 1e-5 and 98 % about 4.7 + 2 of its errors.
    const double error = 0.5 * std::sqrt(2.0 / (1u << 15));
    EXPECT_LT(*sizes.distance, 8 * error);
    EXPECT_GT(*sizes.distance, error / 50);  // replicates have less noise
    EXPECT_LT(*sizes.part, 0.05);
    EXPECT_GT(*sizes.part, 1e-4);
    EXPECT_LT(*sizes.part, *sizes_at(1e-12).part);
}

}  // namespace against_draws_test
}  // namespace crescent::check
