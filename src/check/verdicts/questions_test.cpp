// Tests of the density of known samplers, right and with one fault: whole sums, nodes of the tree, bands of the chart.
#include "check/verdicts/questions.h"

#include <gtest/gtest.h>

#include <set>

#include "check/verdicts/density.h"
#include "check/verdicts/sums.h"
#include "tests/support/sampled_evidence.h"

namespace crescent::check {
namespace questions_test {

void test_density(const Evidence& e, const Visit& visit) {
    test_sums(e, visit);
    test_nodes(e, visit);
    test_bands(e, visit);
}

TEST(CheckFamilies, HaveANameAndAVerdictEach) {
    std::set<std::string_view> names;
    for (int f = 0; f < static_cast<int>(Family::families); ++f) names.insert(info(static_cast<Family>(f)).name);
    EXPECT_EQ(names.size(), static_cast<std::size_t>(Family::families));
    EXPECT_EQ(info(Family::mass_sets).verdict, "normalised");
    EXPECT_EQ(info(Family::delta_direction).verdict, "physics");  // the last one
    EXPECT_TRUE(is_of_f(Family::albedo));
    EXPECT_FALSE(is_of_f(Family::node));
}

TEST(TestsOfDensity, ARightSamplerPassesAll) {
    EXPECT_GT(SampledEvidence({}).least_p(test_density), 1e-3);
    EXPECT_GT(SampledEvidence(power_sampler(50)).least_p(test_density), 1e-3);
}

TEST(TestsOfDensity, AConstantFactorIsADifferenceOfTheMass) {
    FunctionSampler s;
    s.p = [](Vec3d o, Vec3d w) { return 1.02 * cosine_pdf(o, w); };
    const SampledEvidence e(s);
    const auto found = e.least(test_sums, Family::mass);
    ASSERT_TRUE(found);
    EXPECT_LT(found->p(), 1e-10);
    EXPECT_NEAR(found->answer.difference, -0.02, 1e-3);
    EXPECT_NEAR(found->answer.expected, 1.02, 1e-3);
    const auto sums = compare_sums(e.evidence());
    EXPECT_EQ(sums[mass].by_draws.largest, 0);  // every draw is a direction: they have no variance
    EXPECT_FALSE(sums[mass].by_sets);
    EXPECT_GT(sums[bridge].by_draws.largest, 0);
    EXPECT_TRUE(sums[bridge].by_sets);
    EXPECT_GT(e.least(test_nodes, Family::node)->p(), 1e-3);  // shares are right
}

TEST(TestsOfDensity, AnotherShapeIsFoundByMeansAndNodes) {
    FunctionSampler s;  // draws by cosine, p uniform
    s.p = [](Vec3d, Vec3d w) { return w.z > 0 ? 1 / two_pi : 0; };
    const SampledEvidence e(s);
    const auto centre = e.least(test_sums, Family::centre);
    EXPECT_EQ(centre->answer.member, 2);  // z: a larger cosine than p states
    EXPECT_GT(centre->answer.difference, 0);
    EXPECT_LT(centre->p(), 1e-10);
    EXPECT_LT(e.least(test_nodes, Family::node)->p(), 1e-10);
    EXPECT_LT(e.least(test_nodes, Family::node_sets)->p(), 1e-10);
    EXPECT_LT(e.least(test_nodes, Family::depth)->p(), 1e-10);
    EXPECT_GT(e.least(test_sums, Family::mass)->p(), 1e-3);
}

TEST(TestsOfDensity, AnArcWithoutDrawsIsABand) {
    FunctionSampler s;
    s.draw = [](Vec3d o, const PrimarySample& u) { return cosine_draw(o, PrimarySample(u.x, 0.25 + 0.75 * u.y)); };
    const auto band = SampledEvidence(s).least(test_bands, Family::band);
    ASSERT_TRUE(band);
    EXPECT_LT(band->p(), 1e-10);
    const ChartRect where = rect_of_band(band->answer.member);
    EXPECT_EQ(where.phi0, 0);
    EXPECT_NEAR(where.phi1, two_pi / 4, 1e-12);
    EXPECT_NEAR(band->answer.difference / band->answer.expected, -1, 0.05);
}

TEST(TestsOfDensity, WithoutAPdfThereAreNone) {
    FunctionSampler s;
    s.of.has_pdf = false;
    EXPECT_EQ(SampledEvidence(s).least_p(test_density), 1);
}

// 60 of 100 draws in a half that p gives 1/2: the difference 0.1, the variance 1/4 / 100 and that of the integrals.
TEST(SplitsOfNodes, CompareShares) {
    NodeSums a, b;
    a.draw_mean = 0.6;
    b.draw_mean = 0.4;
    a.claim = b.claim = a.second = b.second = 0.5;
    a.variance = b.variance = 1e-4;
    const NodeSplit s = split_between(a, b, 100, 0.01);
    EXPECT_DOUBLE_EQ(s.share, 0.5);
    EXPECT_DOUBLE_EQ(s.difference, 0.1);
    EXPECT_DOUBLE_EQ(s.floor, 0.01);
    EXPECT_DOUBLE_EQ(s.claim_variance, 0.25 * 2e-4);
    EXPECT_DOUBLE_EQ(s.variance, 0.25 / 100 + s.claim_variance);
    EXPECT_DOUBLE_EQ(s.smaller_half, 50);
    a.uncertainty = 0.02;  // p of this half may be off by 4 %
    EXPECT_DOUBLE_EQ(split_between(a, b, 100, 0.01).floor, 0.01 + 0.5 * 0.02);
}

TEST(SplitsOfNodes, TolerateWhatRoundingMoves) {
    TreeNode node;
    node.rect = {0.5, 0.6, 0, 1};
    EXPECT_DOUBLE_EQ(floor_of_cut(node, 0.25), detection_floor * 0.25);
    node.step = 1e-4;
    EXPECT_NEAR(floor_of_cut(node, 0.25),
        detection_floor * 0.25 + 1e-4 / node.rect.theta_width() + 0.25 * 1e-4 / node.rect.phi_width(), 1e-15);
}

}  // namespace questions_test
}  // namespace crescent::check
