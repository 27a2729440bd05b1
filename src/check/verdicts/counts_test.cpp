// Tests of counts: faults of single draws above what is tolerated, repeated directions, shares of delta parts.
#include "check/verdicts/counts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "check/constants.h"
#include "check/verdicts/questions.h"
#include "tests/support/sampled_evidence.h"

namespace crescent::check {
namespace counts_test {

TEST(TestsOfCounts, ARightSamplerPassesAll) {
    const SampledEvidence e({});
    EXPECT_EQ(e.least_p(test_counts), 1);
    EXPECT_EQ(e.least_p(test_deltas), 1);
}

TEST(TestsOfCounts, FaultsOfDrawsFailAboveTheirShare) {
    FunctionSampler s;
    const auto pointwise = [&](double share) {
        s.change = [share](const PrimarySample& u, Draw& d) {
            if (u.x < share) d.pdf *= 1.01;
        };
        return *SampledEvidence(s).least(test_counts, Family::pointwise);
    };
    EXPECT_EQ(pointwise(0).p(), 1);
    EXPECT_EQ(pointwise(5e-5).p(), 1);  // about two of 2^15 draws: tolerated
    EXPECT_EQ(pointwise(2e-3).p(), 0);
    EXPECT_NEAR(pointwise(0.1).answer.difference, 0.1, 0.01);
}

TEST(TestsOfCounts, OneUnusableNumberIsAFault) {
    FunctionSampler s;
    s.p = [](Vec3d o, Vec3d w) { return w.x > 0.99 ? std::numeric_limits<double>::quiet_NaN() : cosine_pdf(o, w); };
    EXPECT_EQ(SampledEvidence(s).least(test_counts, Family::values)->p(), 0);
}

TEST(TestsOfCounts, RepeatedDirectionsOfALatticeAreFound) {
    FunctionSampler s;
    s.draw = [](Vec3d o, const PrimarySample& u) {
        return cosine_draw(o, PrimarySample((std::floor(64 * u.x) + 0.5) / 64, (std::floor(64 * u.y) + 0.5) / 64));
    };
    const auto found = SampledEvidence(s).least(test_counts, Family::repeats);
    EXPECT_EQ(found->p(), 0);
    EXPECT_GT(found->answer.difference, 20000);  // of 2^15 draws at 4096 directions
}

/// A mirror that is drawn with probability `drawn` and states q, over a cosine.
FunctionSampler coat(double drawn, double q) {
    FunctionSampler s;
    s.of.delta = true;
    s.of.numbers = 3;
    s.change = [drawn, q](const PrimarySample& u, Draw& d) {
        if (u[2] >= drawn) return;
        d.wi = {0, 0, 1};
        d.pdf = 0;
        d.delta = q;
        d.weight = 0.5 / q;
        d.weights = {0.5 / q, 0, 0};
    };
    s.p = [q](Vec3d o, Vec3d w) { return (1 - q) * cosine_pdf(o, w); };
    return s;
}

TEST(TestsOfDeltaParts, CompareTheirDrawsWithTheirProbability) {
    EXPECT_GT(SampledEvidence(coat(0.3, 0.3)).least_p(test_deltas), 1e-3);
    const auto found = SampledEvidence(coat(0.33, 0.3)).least(test_deltas, Family::delta_share);
    EXPECT_LT(found->p(), 1e-8);
    EXPECT_NEAR(found->answer.difference, 0.03, 0.01);
    EXPECT_EQ(SampledEvidence(coat(1, 0.3)).least(test_deltas, Family::delta_weight)->p(), 1);
}

TEST(TestsOfDeltaParts, TheirProbabilitiesSumToOneAtMost) {
    FunctionSampler s = coat(1, 0.6);
    s.change = [](const PrimarySample& u, Draw& d) {
        d.wi = {0, 0, u.x < 0.5 ? 1.0 : -1.0};
        d.pdf = 0;
        d.delta = 0.6;
        d.weight = 1;
        d.weights = {1, 0, 0};
    };
    EXPECT_EQ(SampledEvidence(s).least(test_deltas, Family::delta_share)->p(), 0);
}

TEST(TestsOfDeltaParts, SeveralWeightsOrManyDirectionsAreFound) {
    FunctionSampler weights = coat(1, 1), scattered = coat(1, 1);
    weights.change = [](const PrimarySample& u, Draw& d) {
        d.wi = {0, 0, 1};
        d.pdf = 0;
        d.delta = 1;
        d.weight = u.x < 0.5 ? 1 : 2;
        d.weights = {*d.weight, 0, 0};
    };
    scattered.change = [](const PrimarySample&, Draw& d) {
        d.pdf = 0;
        d.delta = 1;
        d.weight = 1;
        d.weights = {1, 0, 0};
    };
    EXPECT_EQ(SampledEvidence(weights).least(test_deltas, Family::delta_weight)->p(), 0);
    EXPECT_EQ(SampledEvidence(weights).least(test_deltas, Family::delta_scatter)->p(), 1);
    EXPECT_EQ(SampledEvidence(scattered).least(test_deltas, Family::delta_scatter)->p(), 0);
}

}  // namespace counts_test
}  // namespace crescent::check
