// Two samplers of which one has no pdf(w), or terminates: draws, f and weights are compared, and the terminated one is
// named.
#include <cmath>
#include <gtest/gtest.h>

#include "check/against.h"
#include "check/check.h"
#include "math/functions.h"
#include "tests/known_samplers/correct/right.h"
#include "tests/support/checked.h"

namespace crescent {
namespace against_without_pdf_test {

CheckResult against(std::span<const CheckCase> a, std::span<const CheckCase> b, bool expect_same = false) {
    ProgressMonitor monitor;
    TestSettings settings;
    settings.budget = check::CheckBudget::limited();
    return compare_samplers(a, b, settings, expect_same, monitor);
}

enum class Gives { pdf, weight, nothing };

/// Lambert of 0.5, drawn by cos^k.
std::shared_ptr<const SamplerAdapter> power(double k, Gives gives) {
    SyntheticSampler r{"power", "", {}, {}, {}};
    const auto p = [k](Vec3d i) { return i.z > 0 ? (k + 1) / (2 * pi) * math::pow(i.z, k) : 0; };
    r.traits.has_pdf = gives == Gives::pdf;
    r.pdf = [=](Vec3d, Vec3d i) { return gives == Gives::pdf ? p(i) : 1; };
    r.f = [](Vec3d, Vec3d i) { return i.z > 0 ? 0.5 / pi : 0; };
    r.sample = [=](Vec3d, const PrimarySample& u) {
        const Vec3d i = math::spherical(math::pow(1 - u[0], 1 / (k + 1)), 2 * pi * u[1]);
        Draw d{i, gives == Gives::pdf ? p(i) : 1};
        if (gives == Gives::weight) d.weight = 0.5 / pi * i.z / p(i);
        return d;
    };
    return make_adapter(r);
}

TEST(AgainstWithoutAPdf, OnlyDifferentDrawsAreDistinguished) {
    for (const auto& [one, other] : {std::pair(Gives::pdf, Gives::weight), {Gives::weight, Gives::pdf},
             {Gives::weight, Gives::weight}, {Gives::nothing, Gives::pdf}}) {
        const std::vector<CheckCase> a = {make_user_case(power(1.5, one), 45, 130)};
        const CheckResult same = against(a, sampler_against(power(1.5, other), a), true),
                          differs = against(a, sampler_against(power(1.8, other), a), true);
        EXPECT_EQ(named(same, "same_distribution").state, State::right) << against_text(same);
        EXPECT_EQ(named(differs, "same_distribution").state, State::wrong) << against_text(differs);
        EXPECT_EQ(named(same, "same_f").state, State::right) << against_text(same);
    }
}

/// Under constant light Var X depends on cos^k: weights returned with the draws give the same value as p.
TEST(AgainstWithoutAPdf, VariancesAreRankedByReturnedWeights) {
    const std::vector<CheckCase> a = {make_user_case(power(0.5, Gives::weight), 45, 130)};
    const CheckResult j = against(a, sampler_against(power(0.8, Gives::pdf), a));
    const Verdict& v = named(j, "variance");
    ASSERT_EQ(v.state, State::right) << against_text(j);
    EXPECT_EQ(v.evidence.value("better", "?"), "B") << v.message();
    // X is cos^(1-k) / (k+1), for p (k+1) cos^k over cos: E[X^2] = 1 / ((k+1) (3-k)), E[X] = 1/2.
    const auto variance = [](double k) { return 1 / ((k + 1) * (3 - k)) - 0.25; };
    const double ratio = variance(0.5) / variance(0.8);
    EXPECT_LT(v.evidence["interval"][0].get<double>(), 1.05 * ratio) << v.message();
    EXPECT_GT(v.evidence["interval"][1].get<double>(), 0.95 * ratio) << v.message();
}

TEST(AgainstWithoutAPdf, NorAWeightThereIsNoVariance) {
    const std::vector<CheckCase> a = {make_user_case(power(1, Gives::pdf), 45, 130)};
    const Verdict v = named(against(a, sampler_against(power(1, Gives::nothing), a)), "variance");
    EXPECT_EQ(v.state, State::skipped);
    EXPECT_NE(v.message().find("B has neither a pdf(w) nor a weight"), std::string::npos) << v.message();
}

/// Returns `questions` draws and then terminates.
class BreaksOff : public InProcessAdapter {
public:
    BreaksOff(std::shared_ptr<const SamplerAdapter> sampler, std::size_t questions)
        : sampler_(std::move(sampler)), left_(questions) {}
    std::string name() const override { return "fickle"; }
    bool serial() const override { return true; }
    bool has_f() const override { return true; }
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        if (left_ < u.size()) throw SamplerError("the program ended with exit code 9");
        left_ -= u.size();
        sampler_->sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override { sampler_->pdf(t, at, out); }
    void f(std::span<const Pair> at, std::span<double> out) const override { sampler_->f(at, out); }

private:
    std::shared_ptr<const SamplerAdapter> sampler_;
    mutable std::size_t left_;
};

TEST(Against, WhatBreaksOffIsNamed) {
    const auto well = power(1, Gives::pdf);
    for (const bool first : {true, false}) {
        const auto breaks = std::make_shared<BreaksOff>(power(1, Gives::pdf), 1000);
        const std::vector<CheckCase> a = {
            make_user_case(first ? std::shared_ptr<const SamplerAdapter>(breaks) : well, 45, 130)};
        const CheckResult j =
            against(a, sampler_against(first ? well : std::shared_ptr<const SamplerAdapter>(breaks), a));
        EXPECT_EQ(j.state, State::error);
        const std::string who = first ? "sampler A (fickle): " : "sampler B (fickle): ";
        EXPECT_NE(named(j, "variance").message().find("failed: " + who), std::string::npos)
            << named(j, "variance").message();
    }
}

}  // namespace against_without_pdf_test
}  // namespace crescent
