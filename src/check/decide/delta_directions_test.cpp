// Samplers with delta parts: right samplers have right verdicts, and each fault of a part makes the expected verdict
// wrong.
#include "check/decide/delta_directions.h"

#include <gtest/gtest.h>

#include "check/decide/check_at.h"
#include "check/decide/small_tests.h"

namespace crescent::check {
namespace delta_directions_test {

/// A specular coat that is chosen with probability q, over Lambert of albedo `base`.
struct Coat : SamplerSource {
    double q = 0.3, chosen = 0.3, base = 0.5, mirrored_share = 0.2;
    double of_other_draws = 1;  // factor on the weight of every second draw of the part
    Vec3d turned{-1, -1, 1};    // reflected direction in units of w_o
    std::string name() const override { return "coat"; }
    Traits traits() const override {
        Traits t;
        t.numbers = 3;
        t.delta = true;
        return t;
    }
    void sample(int, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            out[i] = {};
            if (u[i][2] < chosen) {
                out[i].wi = {turned.x * wo.x, turned.y * wo.y, turned.z * wo.z};
                out[i].delta = q;
                out[i].weight = mirrored_share / q * (u[i].x < 0.5 ? of_other_draws : 1);
                continue;
            }
            const double z = std::sqrt(u[i].x), r = std::sqrt(1 - z * z);
            out[i].wi = {r * std::cos(two_pi * u[i].y), r * std::sin(two_pi * u[i].y), z};
            out[i].pdf = density_at(z);
            out[i].weight = base / (1 - q);
        }
    }
    double density_at(double z) const { return z > 0 ? (1 - q) * z / pi : 0; }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = density_at(at[i].wi.z);
    }
    bool has_f() const override { return true; }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = at[i].wi.z > 0 ? base / pi : 0;
    }
};

CheckAt checked_delta(const SamplerAdapter& s, Vec3d wo = tilt(40, 30)) {
    return check_sampler_at(s, 0, wo, {}, CheckBudget::limited(), 1);
}
bool names(const CheckAt& c, std::string_view verdict) {
    return std::ranges::any_of(c.findings, [&](const Finding& f) { return info(f.first.family).verdict == verdict; }) ||
        std::ranges::any_of(c.small, [&](const SmallFault& f) { return info(f.family).verdict == verdict; });
}

TEST(DeltaPartsOfASampler, AreRightIfDrawnWithTheStatedProbability) {
    const CheckAt c = checked_delta(Coat{});
    EXPECT_FALSE(c.wrong());
    ASSERT_EQ(c.observations.deltas.parts(c.observations.independent).size(), 1u);
    EXPECT_NEAR(c.observations.delta_power[0], 0.2, 1e-9);
}

TEST(DeltaPartsOfASampler, WithAWrongProbabilityMakeTheDensityWrong) {
    Coat coat;
    coat.chosen = 0.27;
    EXPECT_TRUE(names(checked_delta(coat), "density"));
}

TEST(DeltaPartsOfASampler, WithSeveralWeightsBreakIdentity) {
    Coat coat;
    coat.of_other_draws = 1.1;
    const CheckAt c = checked_delta(coat);
    EXPECT_TRUE(names(c, "identity"));
    EXPECT_FALSE(names(c, "density"));
}

TEST(DeltaPartsOfASampler, AreIncludedInTheAlbedo) {
    Coat coat;
    coat.mirrored_share = 0.51;
    EXPECT_TRUE(names(checked_delta(coat), "physics"));
    coat.mirrored_share = 0.49;
    EXPECT_FALSE(names(checked_delta(coat), "physics"));
}

TEST(DeltaPartsOfASampler, ReturnAlongTheReversePath) {
    Coat flipped;
    flipped.turned = {-1, 1, 1};
    EXPECT_FALSE(checked_delta(flipped).wrong());  // an unusual mirror that is its own inverse
    struct OneWay : Coat {
        void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
            Coat::sample(t, wo, u, out);
            for (Draw& d : out)
                if (d.delta > 0 && wo.x > 0) d.wi.y = -d.wi.y;
        }
    };
    EXPECT_TRUE(names(checked_delta(OneWay{}), "physics"));
}

/// Smooth glass that reflects 0.1 and refracts by the index `drawn`, where 1.5 is stated.
struct Boundary : SamplerSource {
    double drawn = 1.5;
    std::string name() const override { return "boundary"; }
    Traits traits() const override {
        Traits t;
        t.numbers = 3;
        t.delta = true;
        t.eta = 1.5;
        t.wo = Traits::WoDomain::both;
        return t;
    }
    void sample(int, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            out[i] = {{-wo.x, -wo.y, wo.z}, 0, 1.0, {}};
            const double e = wo.z > 0 ? drawn : 1 / drawn, scale = wo.z > 0 ? 1 / 2.25 : 2.25,
                         rest = 1 - (1 - wo.z * wo.z) / (e * e);
            out[i].delta = 0.1;
            if (rest < 0) out[i].delta = 1;
            else if (u[i].x > 0.1) {
                out[i].wi = {-wo.x / e, -wo.y / e, -std::copysign(std::sqrt(rest), wo.z)};
                out[i].delta = 0.9;
                out[i].weight = scale;
            }
        }
    }
    void pdf(int, std::span<const Pair>, std::span<double> out) const override { std::ranges::fill(out, 0.0); }
};

TEST(DeltaPartsOfASampler, AreRefractedByTheStatedIndex) {
    Boundary right, inverted, other;
    inverted.drawn = 1 / 1.5;
    other.drawn = 1.4;
    for (double theta : {0.0, 30.0, 150.0, 180.0}) EXPECT_FALSE(checked_delta(right, tilt(theta)).wrong()) << theta;
    const CheckAt wrong = checked_delta(inverted, tilt(30));
    ASSERT_FALSE(wrong.small.empty());
    EXPECT_EQ(wrong.small.back().family, Family::delta_direction);
    EXPECT_NE(std::string(wrong.small.back().what).find("1 / eta"), std::string::npos);
    EXPECT_TRUE(names(checked_delta(other, tilt(30)), "physics"));
}

}  // namespace delta_directions_test
}  // namespace crescent::check
