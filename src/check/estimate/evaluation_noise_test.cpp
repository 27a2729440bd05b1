// Answers that are random estimates.
#include "check/estimate/evaluation_noise.h"

#include <bit>
#include <gtest/gtest.h>

#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace evaluation_noise_test {

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

}  // namespace evaluation_noise_test
}  // namespace crescent::check
