// Cosine powers on Lambert have a known Pareto index; lobes that leave Lambert's light to directions they rarely draw
// have an unseen tail.
#include "check/decide/tail.h"

#include <gtest/gtest.h>

#include "check/decide/check_at.h"

namespace crescent::check {
namespace tail_test {

/// p ~ cos^s about n, mixed with a share of cosine; f is Lambert of albedo 1. Without the cosine the weights are u^-k,
/// k = (s - 1) / (s + 1).
struct PowerLobe : SamplerSource {
    double s = 1, share = 0;
    std::string name() const override { return "power"; }
    Traits traits() const override {
        Traits t;
        t.numbers = 3;
        return t;
    }
    double density_at(double z) const {
        return z > 0 ? (1 - share) * (s + 1) / two_pi * std::pow(z, s) + share * z / pi : 0;
    }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            const double z = std::pow(u[i].x, 1 / ((u[i][2] < share ? 1 : s) + 1)), r = std::sqrt(1 - z * z);
            out[i] = {{r * std::cos(two_pi * u[i].y), r * std::sin(two_pi * u[i].y), z}, density_at(z)};
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = density_at(at[i].wi.z);
    }
    bool has_f() const override { return true; }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = at[i].wi.z > 0 ? 1 / pi : 0;
    }
};

struct CheckedTail {
    Verdict tail, mean;
    WeightTail of;
};
CheckedTail tail_at(const PowerLobe& sampler) {
    CheckCase t;
    t.wo = {0, 0, 1};
    t.adapter = std::make_shared<PowerLobe>(sampler);
    const CheckAt c = check_sampler_at(*t.adapter, 0, t.wo, {}, CheckBudget::limited(), 1);
    for (const Finding& f : c.findings) ADD_FAILURE() << info(f.first.family).name << f.first.difference;
    for (const SmallFault& f : c.small) ADD_FAILURE() << f.what << f.size;
    CheckedTail out;
    out.of = tail_of({&c, 1});
    test_tail(t, out.of, out.tail);
    test_plain_mean(out.of, out.mean);
    return out;
}

TEST(TailOfWeights, HasTheIndexOfTheory) {
    for (double s : {2.0, 8.0, 32.0}) {
        PowerLobe lobe;
        lobe.s = s;
        const CheckedTail t = tail_at(lobe);
        ASSERT_TRUE(t.of.fit) << s;
        const double k = (s - 1) / (s + 1);
        EXPECT_NEAR(t.of.fit->k, k, 3 * t.of.fit->se) << s;
        EXPECT_EQ(t.tail.state, k < 0.5 ? State::right : State::inconclusive) << s << t.tail.message();
        EXPECT_EQ(t.mean.state, k < 0.5 ? State::right : State::inconclusive) << s << t.mean.message();
        EXPECT_EQ(t.tail.next.kind == NextStep::Kind::none, k < 0.5);
    }
}

TEST(TailOfWeights, IsRightForEqualWeights) {
    const CheckedTail t = tail_at({});
    EXPECT_EQ(t.tail.state, State::right);
    EXPECT_FALSE(t.of.has_unseen());
    EXPECT_NEAR(t.tail.evidence["samples_for_1_percent"].get<double>(), 1, 1e-9);
}

TEST(TailOfWeights, ReportsThePlainMeanAndItsError) {
    PowerLobe lobe;
    lobe.s = 2;
    const nlohmann::ordered_json e = tail_at(lobe).mean.evidence;
    const double error = e["standard_error"].get<double>();
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 0.01);
    EXPECT_NEAR(e["mean"].get<double>(), e["quadrature"].get<double>(), 5 * error);
    EXPECT_NEAR(e["quadrature"].get<double>(), 1, 1e-3);  // the albedo
}

/// One draw in 1e6 comes from the cosine, which contributes nearly all of the light; the draws contain none of them.
TEST(TailOfWeights, IsFoundByThePointsIfNoDrawShowsIt) {
    PowerLobe lobe;
    lobe.s = 1e4;
    lobe.share = 1e-6;
    const CheckedTail t = tail_at(lobe);
    EXPECT_TRUE(t.of.has_unseen());
    EXPECT_EQ(t.tail.state, State::inconclusive);
    EXPECT_EQ(t.mean.state, State::inconclusive);
    EXPECT_GT(t.tail.evidence["unmet_share"].get<double>(), 0.9);
    EXPECT_NEAR(t.tail.evidence["unmet_half_chance"].get<double>(), 5e-7, 2e-7);
    EXPECT_NE(t.tail.message().find("Heavy tail that no draw met"), std::string::npos);
    EXPECT_EQ(t.tail.next.kind, NextStep::Kind::heavier_pdf);  // 120 times as many draws would be enough
}

/// The same cosine, drawn often enough: a step of the weights, not a tail.
TEST(TailOfWeights, IsAbsentForAFrequentStep) {
    PowerLobe lobe;
    lobe.s = 1e4;
    lobe.share = 0.02;
    EXPECT_EQ(tail_at(lobe).tail.state, State::right);
}

}  // namespace tail_test
}  // namespace crescent::check
