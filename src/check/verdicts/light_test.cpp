// Tests of the mean, the support and the albedo of known samplers, and of the tail of weights.
#include "check/verdicts/light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "check/constants.h"
#include "check/verdicts/questions.h"
#include "tests/support/sampled_evidence.h"

namespace crescent::check {
namespace light_test {

/// A cosine sampler of a Lambert surface, whose weight is the albedo.
FunctionSampler of_lambert(double albedo) {
    FunctionSampler s;
    s.f_value = lambert(albedo);
    s.weights = [albedo](Vec3d, Vec3d) { return Vec3d{albedo, 0, 0}; };
    return s;
}

TEST(TestsOfLight, ARightSamplerPassesAll) {
    const SampledEvidence e(of_lambert(0.8));
    EXPECT_GT(e.least_p(test_light), 1e-3);
    EXPECT_TRUE(mean_can_be_tested(e.evidence()));
    const auto mean = e.least(test_light, Family::mean);
    ASSERT_TRUE(mean);
    EXPECT_EQ(mean->members, 1);
    EXPECT_NEAR(mean->answer.expected, 0.4, 0.01);  // bridged: half of the integral, as f cos / p is the usual weight
}

TEST(TestsOfLight, AnAlbedoAboveOneIsFound) {
    const auto found = SampledEvidence(of_lambert(1.05)).least(test_light, Family::albedo);
    EXPECT_LT(found->p(), 1e-10);
    EXPECT_NEAR(found->answer.difference, 0.05, 2e-3);
    EXPECT_GT(SampledEvidence(of_lambert(1)).least(test_light, Family::albedo)->p(), 0.9);
}

TEST(TestsOfLight, DrawsThatDoNotFollowPHaveAnotherMean) {
    FunctionSampler s = of_lambert(0.5);
    s.draw = [](Vec3d o, const PrimarySample& u) { return cosine_draw(o, PrimarySample(u.x * u.x, u.y)); };
    s.p = [](Vec3d, Vec3d w) { return w.z > 0 ? 1 / two_pi : 0; };
    s.weights = [](Vec3d, Vec3d w) { return Vec3d{w.z, 0, 0}; };
    const auto found = SampledEvidence(s).least(test_light, Family::mean);
    ASSERT_TRUE(found);
    EXPECT_LT(found->p(), 1e-10);
    EXPECT_GT(found->answer.difference, 0);  // more draws at large cosines, where f cos / p is large
}

TEST(TestsOfLight, LightWherePIsZeroIsFound) {
    FunctionSampler s = of_lambert(0.5);
    s.draw = [](Vec3d o, const PrimarySample& u) { return cosine_draw(o, PrimarySample(u.x, 0.1 + 0.9 * u.y)); };
    s.p = [](Vec3d o, Vec3d w) {
        const double phi = to_chart(w).phi;
        return phi < 0.1 * two_pi ? 0 : cosine_pdf(o, w) / 0.9;
    };
    const SampledEvidence e(s);
    const auto found = e.least(test_light, Family::support);
    EXPECT_LT(found->p(), 1e-10);
    EXPECT_NEAR(found->answer.difference / found->answer.expected, 0.1, 0.01);
    EXPECT_EQ(SampledEvidence(of_lambert(0.5)).least(test_light, Family::support)->p(), 1);
}

TEST(TestsOfLight, WithoutAPdfWeightsAreComparedByNodes) {
    FunctionSampler s = of_lambert(0.5);
    s.of.has_pdf = false;
    s.weights = nullptr;
    s.change = [](const PrimarySample&, Draw& d) {
        d.pdf = 1;
        d.weight = 0.5;
        d.weights = {0.5, 0, 0};
    };
    const auto right = SampledEvidence(s).least(test_light, Family::mean);
    ASSERT_TRUE(right);
    EXPECT_GT(right->members, 5);
    EXPECT_GT(right->p(), 1e-3);
    s.change = [](const PrimarySample&, Draw& d) {  // the mean of all is right
        const double w = d.wi.y > 0 ? 0.6 : 0.4;
        d.pdf = 1;
        d.weight = w;
        d.weights = {w, 0, 0};
    };
    EXPECT_LT(SampledEvidence(s).least(test_light, Family::mean)->p(), 1e-6);
}

TEST(TailsOfWeights, MayBeHeavyFromIndexOneHalfOn) {
    const auto heavy = [](double k) {
        std::vector<double> x;
        Stream stream({1});
        for (int i = 0; i < 20000; ++i) x.push_back(std::pow(stream.number(), -k));
        return tail_may_be_heavy(x);
    };
    EXPECT_TRUE(heavy(0.8));
    EXPECT_FALSE(heavy(0.25));
    EXPECT_FALSE(tail_may_be_heavy(std::vector<double>{1, 2, 3.9, 1}));  // at most four means
}

TEST(TailsOfWeights, OfARareLobeAreAStep) {
    std::vector<double> x;
    Stream stream({1});
    for (int i = 0; i < 20000; ++i) x.push_back((i < 100 ? 20 : 1) * (0.9 + 0.2 * stream.number()));
    EXPECT_FALSE(tail_may_be_heavy(x));
}

}  // namespace light_test
}  // namespace crescent::check
