// Causes for weights and f, whose ratio to the expected value is known at every draw.
#include "check/explain/weights.h"

#include <gtest/gtest.h>

#include "tests/support/explained.h"

namespace crescent::check {
namespace weights_test {

TEST(RatiosOfWeights, NameAFactorOrAConstant) {
    FunctionSampler m = made(cosine_draw, cosine_pdf);
    m.f_value = [](Vec3d, Vec3d w) { return w.z > 0 ? 0.5 / pi : 0; };
    m.weights = [](Vec3d, Vec3d w) { return Vec3d{0.5 / w.z, 0, 0}; };
    Explained r = explained(m);
    expect_cause(r, "cos theta_i");
    EXPECT_NE(r.text().find("over cos theta_i"), std::string::npos) << r.text();
    m.weights = [](Vec3d, Vec3d) { return Vec3d{0.25, 0, 0}; };
    r = explained(m);
    expect_cause(r, "constant");
    EXPECT_NE(r.text().find("0.5 = 1/2"), std::string::npos) << r.text();
}

TEST(RatiosOfWeights, NameExchangedChannels) {
    struct Colour : FunctionSampler {
        void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override {
            for (std::size_t i = 0; i < at.size(); ++i) {
                const double f = at[i].wi.z > 0 ? 1 / pi : 0;
                out[i] = {0.2 * f, 0.4 * f, 0.8 * f};
            }
        }
    };
    const auto adapter = std::make_shared<Colour>();
    adapter->of.channels = 3;
    adapter->f_value = lambert(luminance(Vec3d{0.2, 0.4, 0.8}));
    adapter->change = [](const PrimarySample&, Draw& d) {
        d.weights = {0.8, 0.4, 0.2};
        d.weight = luminance(d.weights);
    };
    Explained r;
    CheckCase& t = r.check_cases.emplace_back();
    t.arm = "made";
    t.wo = {0, 0, 1};
    t.adapter = adapter;
    CheckSettings settings;
    settings.budget = CheckBudget::limited(1e5);
    ProgressMonitor monitor;
    r.outcomes = check_samplers(r.check_cases, settings, monitor);
    const auto cause = weight_cause(r.check_cases, r.outcomes.at(0));
    ASSERT_TRUE(cause);
    EXPECT_EQ(cause->factor, "channels 1 and 3 exchanged");
    EXPECT_EQ(cause->verdict, "identity");
}

TEST(RatiosOfWeights, AreNotExplainedIfTheyAreRight) {
    FunctionSampler m;
    m.f_value = lambert(0.5);
    m.weights = [](Vec3d, Vec3d) { return Vec3d{0.5, 0, 0}; };
    const Explained r = checked(m);
    EXPECT_FALSE(r.wrong());
    EXPECT_FALSE(weight_cause(r.check_cases, r.outcomes.at(0)));
}

}  // namespace weights_test
}  // namespace crescent::check
