// Findings become verdicts.
#include "check/report/verdicts.h"

#include <gtest/gtest.h>

namespace crescent::check {
namespace verdicts_test {

struct Uniform : SamplerSource {
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
    t.arm = "uniform";
    t.wo = {0, 0, 1};
    t.adapter = std::make_shared<Uniform>(factor);
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
    const double least = named(all, "normalised").evidence["would_have_found"]["constant"].get<double>();
    EXPECT_LT(least, 1e-3);
    EXPECT_GT(least, 1e-6) << "no number of draws shows a fault of any size";
}

TEST(CheckReport, ConstantFactorIsWrongNormalisationWithItsCause) {
    const auto all = verdicts(2);
    EXPECT_EQ(named(all, "normalised").state, State::wrong);
    EXPECT_EQ(named(all, "normalised").evidence["diagnosis"], "constant");
    EXPECT_EQ(named(all, "identity").state, State::right);
}

/// Draws and has a density only for w_o on one side.
struct OneSided : Uniform {
    bool never = false;
    OneSided() : Uniform(1) {}
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        if (!never && wo.z > 0) return Uniform::sample(t, wo, u, out);
        for (Draw& d : out) d = {{0, 0, 1}, 0};
    }
    void pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        Uniform::pdf(t, pairs, out);
        for (std::size_t i = 0; i < out.size(); ++i)
            if (never || pairs[i].wo.z <= 0) out[i] = 0;
    }
    Traits traits() const override {
        Traits t;
        t.wo = Traits::WoDomain::both;
        return t;
    }
};

TEST(CheckReport, WhatDrawsNothingIsNeverRight) {
    for (bool never : {false, true}) {
        const auto sampler = std::make_shared<OneSided>();
        sampler->never = never;
        CheckCase above, below;
        above.arm = below.arm = "one-sided";
        above.adapter = below.adapter = sampler;
        above.wo = {0, 0, 1};
        below.wo = {0, 0, -1};
        const CheckCase both[] = {above, below};
        CheckSettings settings;
        settings.budget = CheckBudget::limited(1e5);
        ProgressMonitor monitor;
        const auto outcome = check_samplers(both, settings, monitor);
        const auto all = verdicts_of(both, outcome.at(0), {});
        for (const char* name : {"normalised", "density", "identity"}) {
            const auto first = std::ranges::find(all, name, &Verdict::name),
                       second = std::find_if(first + 1, all.end(), [&](const Verdict& v) { return v.name == name; });
            EXPECT_EQ(second->state, never ? State::inconclusive : State::skipped) << name;
            EXPECT_EQ(first->state == State::inconclusive, never) << name;
        }
    }
}

}  // namespace verdicts_test
}  // namespace crescent::check
