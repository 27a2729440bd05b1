// Findings become verdicts.
#include "check/report/verdicts.h"

#include <gtest/gtest.h>

namespace crescent::check {
namespace verdicts_test {

struct Uniform : SamplerAdapter {
    double factor = 1;
    explicit Uniform(double by) : factor(by) {}
    std::string name() const override { return "uniform"; }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) out[i] = {from_chart({u[i].x, two_pi * u[i].y}), factor / two_pi};
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = at[i].wi.z > 0 ? factor / two_pi : 0;
    }
};

std::vector<Verdict> verdicts(double factor) {
    CheckCase t;
    t.arm = "uniform", t.wo = {0, 0, 1}, t.adapter = std::make_shared<Uniform>(factor);
    CheckSettings settings;
    settings.budget = CheckBudget::limited();
    ProgressMonitor monitor;
    const auto all = check_samplers({&t, 1}, settings, monitor);
    return verdicts_of({&t, 1}, all.at(0), cause_of({&t, 1}, all.at(0)));
}

const Verdict& named(const std::vector<Verdict>& all, std::string_view name) {
    return *std::ranges::find(all, name, &Verdict::name);
}

TEST(CheckReport, RightSamplerHasRightVerdictsAndStatesItsPower) {
    const auto all = verdicts(1);
    EXPECT_EQ(named(all, "normalised").state, State::right);
    EXPECT_EQ(named(all, "density").state, State::right);
    EXPECT_EQ(named(all, "mean").state, State::skipped);
    EXPECT_LT(named(all, "normalised").evidence["would_have_found"]["constant"].get<double>(), 1e-3);
}

TEST(CheckReport, ConstantFactorIsWrongNormalisationWithItsCause) {
    const auto all = verdicts(2);
    EXPECT_EQ(named(all, "normalised").state, State::wrong);
    EXPECT_EQ(named(all, "normalised").evidence["diagnosis"], "constant");
    EXPECT_EQ(named(all, "identity").state, State::right);
}

}  // namespace verdicts_test
}  // namespace crescent::check
