// Answers that are random estimates, functions that are reciprocal, and steps of single precision.
#include "check/estimate/scatter.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "check/constants.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace {

const CaseLighting uniform_light;

EvaluationNoise noise_of(const FunctionSampler& s) {
    Source source(s, 0, {0, 0, 1}, uniform_light);
    return look_for_noise(source, {1, 0, 0, 1, Purpose::pairs});
}

TEST(EvaluationNoise, IsFoundInAnswersThatDiffer) {
    FunctionSampler exact, random, hashed;
    exact.f_value = lambert(0.5);
    EXPECT_FALSE(noise_of(exact).pdf() || noise_of(exact).f());
    int call = 0;
    random.p = [&call](Vec3d o, Vec3d w) { return cosine_pdf(o, w) * (1 + 0.2 * (call++ % 7)); };
    EXPECT_GT(noise_of(random).of_pdf, 0.05);
    EXPECT_FALSE(noise_of(random).hashed);
    hashed.f_value = [](Vec3d, Vec3d w) {
        const std::uint64_t bits = std::bit_cast<std::uint64_t>(w.x) * 0x9e3779b97f4a7c15u;
        return w.z > 0 ? static_cast<double>(bits >> 40) * 0x1p-24 : 0;
    };
    EXPECT_TRUE(noise_of(hashed).f());
    EXPECT_TRUE(noise_of(hashed).hashed);
    EXPECT_FALSE(noise_of(hashed).pdf());
}

TEST(EvaluationNoise, ASharpLobeIsNone) {
    FunctionSampler sharp;
    sharp.p = [](Vec3d, Vec3d w) { return power_pdf({0, 0, 1}, 1e4, w); };
    sharp.draw = [](Vec3d, const PrimarySample& u) { return power_draw({0, 0, 1}, 1e4, u); };
    EXPECT_FALSE(noise_of(sharp).pdf());
}

TEST(BothWaysOfF, TellBrdfsFromPhaseFunctions) {
    const StreamKey key{1, 0, 0, 1, Purpose::pairs};
    FunctionSampler phase, same, lossy;
    for (FunctionSampler* s : {&phase, &same, &lossy}) s->of.wo = Traits::WoDomain::both;
    phase.f_value = [](Vec3d, Vec3d w) { return 0.1 / std::fabs(w.z); };
    same.f_value = [](Vec3d o, Vec3d w) { return 0.1 + 0.05 * dot(o, w); };
    lossy.f_value = [](Vec3d o, Vec3d) { return 0.1 + 0.1 * o.z * o.z; };
    EXPECT_EQ(both_ways(phase, key), BothWays::phase_function);
    EXPECT_EQ(both_ways(same, key), BothWays::same_f);
    EXPECT_EQ(both_ways(lossy, key), BothWays::not_known);
    same.of.eta = Index(1.5);  // a stated index needs no guess
    EXPECT_EQ(both_ways(same, key), BothWays::not_known);
}

TEST(LocalSteps, AreThoseOfSinglePrecision) {
    // A cosine next to 1 has a step of 2^-24: the angle jumps between sqrt(2 k 2^-24).
    const auto steps = [](bool single) {
        FunctionSampler s;
        s.draw = [single](Vec3d, const PrimarySample& u) {
            double z = 1 - 1e-6 * u[0];
            if (single) z = static_cast<double>(static_cast<float>(z));
            const double r = std::sqrt(1 - z * z);
            return Vec3d{r * std::cos(two_pi * u[1]), r * std::sin(two_pi * u[1]), z};
        };
        s.p = [](Vec3d, Vec3d) { return 1.0; };
        Source source(s, 0, {0, 0, 1}, uniform_light);
        std::vector<PrimarySample> u;
        for (std::uint32_t i = 0; i < 64; ++i) u.push_back(numbers_at({1}, i, 2, true));
        std::vector<Draw> draws(u.size());
        source.draw(u, draws);
        std::vector<Vec3d> w;
        for (const Draw& d : draws) w.push_back(d.wi);
        double sum = 0;
        for (const LocalStep& step : local_steps(source, u, w)) sum += step.jump / 64;
        return sum;
    };
    EXPECT_EQ(steps(false), 0);
    const double typical = 0x1p-24 / std::sqrt(1e-6);  // dz = theta dtheta, at a typical theta of 1e-3
    EXPECT_GT(steps(true), typical / 3);
    EXPECT_LT(steps(true), typical * 3);
}

}  // namespace
}  // namespace crescent::check
