// Calls to a sampler at one w_o: their count, unusable answers, and the rows of a file for each stream.
#include "check/estimate/source.h"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <set>

#include "check/constants.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace source_test {

const CaseLighting uniform_light;

TEST(CheckSource, UnusableAnswersAreZeroAndCounted) {
    FunctionSampler s;
    s.p = [](Vec3d, Vec3d w) { return w.x > 0.5 ? -1.0 : w.y > 0.5 ? std::numeric_limits<double>::infinity() : 0.25; };
    Source source(s, 0, {0, 0, 1}, uniform_light);
    const Vec3d wi[] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    double p[3];
    source.density(wi, p);
    EXPECT_EQ(p[0], 0.25);
    EXPECT_EQ(p[1], 0);
    EXPECT_EQ(p[2], 0);
    EXPECT_EQ(source.invalid().count(), 2u);
    EXPECT_EQ(source.evaluations(), 3u);
    double stated[3];
    source.stated_pdf(wi, stated);
    EXPECT_EQ(stated[1], -1);
    EXPECT_EQ(source.invalid().count(), 2u);  // numbers are returned unchanged here
}

TEST(CheckSource, WithoutADensityItIsOne) {
    FunctionSampler s;
    Source source(s, 0, {0, 0, 1}, uniform_light);
    source.by_draws = true;
    EXPECT_EQ(source.density({0, 0, 1}), 1);
    EXPECT_EQ(source.evaluations(), 0u);
}

TEST(CheckSource, FHasTheCosineOfEitherSide) {
    FunctionSampler s;
    s.f_value = [](Vec3d, Vec3d) { return 2.0; };
    Source source(s, 0, {0, 0, 1}, uniform_light);
    const Vec3d wi[] = {tilt(60), tilt(120)};
    Vec3d f[2];
    source.f_cos(wi, f);
    EXPECT_NEAR(f[0].x, 1, 1e-12);
    EXPECT_NEAR(f[1].z, 1, 1e-12);
}

TEST(CheckSource, LightBelowTheSurfaceIsItsUniformPart) {
    FunctionSampler s;
    CaseLighting light;
    light.fill = 0.5;
    light.disks.push_back({20, {0, 0, 2}, {0, 0, -1}, 1});
    const Source source(s, 0, {0, 0, 1}, light);
    EXPECT_EQ(source.radiance({0, 0, 1}), 20);
    EXPECT_EQ(source.radiance({0, 0, -1}), 0.5);
    EXPECT_EQ(source.radiance(tilt(80)), 0.5);
}

struct File : RecordedSampler {
    explicit File(int rows) {
        for (int i = 0; i < rows; ++i) {
            u_.emplace_back(i, 0);
            draws_.push_back({{0, 0, 1}, 1});
        }
    }
    std::string name() const override { return "file"; }
    void pdf(int, std::span<const Pair>, std::span<double>) const override {}
    std::string place(std::size_t) const override { return ""; }
};

TEST(CheckSource, NoRowOfAFileIsUsedTwice) {
    const File file(83);
    Source source(file, 0, {0, 0, 1}, uniform_light);
    std::multiset<double> used;
    for (const auto& [purpose, stage] : {std::pair{Purpose::pilot, std::uint8_t{1}}, {Purpose::draws, std::uint8_t{1}},
             {Purpose::draws, std::uint8_t{2}}}) {
        const StreamKey key{1, 0, 0, stage, purpose};
        std::vector<PrimarySample> u(source.available(key, 1000));
        std::vector<Draw> draws(u.size());
        source.draw(key, 0, u, draws);
        for (const PrimarySample& row : u) used.insert(row.x);
    }
    EXPECT_EQ(used.size(), 83u);
    EXPECT_EQ(std::set<double>(used.begin(), used.end()).size(), 83u);
    EXPECT_EQ(source.available({1, 0, 0, 1, Purpose::draws}, 10), 10u);
}

TEST(CheckSource, ADrawBelowCountsIfThereIsADensity) {
    const Traits surface;
    EXPECT_TRUE(is_direction(surface, {{0, 0, 1}, 1}, 0));
    EXPECT_FALSE(is_direction(surface, {{0, 0, -1}, 1}, 0));
    EXPECT_TRUE(is_direction(surface, {{0, 0, -1}, 1}, 0.1));
    EXPECT_FALSE(is_direction(surface, {{0, 0, 1}, 0}, 1));
    Traits light;
    light.wo = Traits::WoDomain::none;
    EXPECT_TRUE(is_direction(light, {{0, 0, -1}, 1}, 0));
    Draw delta{{0, 0, 1}, 1};
    delta.delta = 0.5;
    EXPECT_FALSE(is_direction(surface, delta, 1));
}

// ---- Answers that are random estimates, functions that are reciprocal, and steps of single precision.

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
    EXPECT_GT(noise_of(random).pdf_noise, 0.05);
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
        for (std::uint32_t i = 0; i < 64; ++i) u.push_back(numbers_at({1}, i, 2, Resolution::single));
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

}  // namespace source_test
}  // namespace crescent::check
