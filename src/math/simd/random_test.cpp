// The published values of pcg4d, then equidistribution and correlations to five standard deviations.
#include "math/simd/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace crescent {
namespace random_test {

TEST(RandomStreams, Pcg4dGivesThePublishedFunction) {  // values from a separate implementation of the paper's listing
    const auto v = pcg4d(Vec4u<std::uint32_t>{1, 2, 3, 4});
    EXPECT_EQ(v.x, 0x3622cd16u);
    EXPECT_EQ(v.y, 0xf11471d8u);
    EXPECT_EQ(v.z, 0xe1109b3fu);
    EXPECT_EQ(v.w, 0x2b94c2fu);
}

TEST(RandomStreams, UNeverReachesZeroOrOneAndIsExact) {
    EXPECT_EQ(unit_float<float>(0u), 0x1p-24f);
    EXPECT_EQ(unit_float<float>(0xffffffffu), 1 - 0x1p-24f);
    EXPECT_EQ(unit_float<float>(0x80000000u), 0.5f + 0x1p-24f);
}

/// Chi-square of pairs (u1, u2) on a grid of 16 x 16: 255 degrees of freedom, mean 255, standard deviation 22.6.
double chi_square_of_pairs(std::uint32_t pixel_step, std::uint32_t sample_step) {
    std::array<double, 256> count{};
    constexpr int n = 256 * 400;
    for (std::uint32_t i = 0; i < n; ++i) {
        const Vec2<float> u = draw(329363537, i * pixel_step, i * sample_step);
        ++count[static_cast<std::size_t>(u.x * 16) * 16 + static_cast<std::size_t>(u.y * 16)];
    }
    double sum = 0;
    for (double c : count) sum += (c - 400) * (c - 400) / 400;
    return sum;
}

TEST(RandomStreams, PairsFillTheSquareBySampleAndPixel) {
    for (const double chi : {chi_square_of_pairs(0, 1), chi_square_of_pairs(1, 0), chi_square_of_pairs(1, 1),
             chi_square_of_pairs(960, 0)}) {
        EXPECT_GT(chi, 255 - 5 * 22.6);
        EXPECT_LT(chi, 255 + 5 * 22.6);
    }
}

TEST(RandomStreams, NeighboursAreUncorrelated) {
    constexpr int n = 100'000;
    double along_samples = 0, along_pixels = 0, across_blocks = 0, across_dimensions = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double u = static_cast<double>(draw(7, 5, i).x) - 0.5;
        along_samples += u * (static_cast<double>(draw(7, 5, i + 1).x) - 0.5);
        across_blocks += u * (static_cast<double>(draw(7, 5, i, 1).x) - 0.5);
        across_dimensions += u * (static_cast<double>(draw(7, 5, i).y) - 0.5);
        along_pixels += (static_cast<double>(draw(7, i, 5).x) - 0.5) * (static_cast<double>(draw(7, i + 1, 5).x) - 0.5);
    }
    const double bound = 5 * std::sqrt(n / 144.0);  // variance of a product of two centred uniforms: 1/144
    for (double sum : {along_samples, along_pixels, across_blocks, across_dimensions}) EXPECT_LT(std::fabs(sum), bound);
}

TEST(RandomStreams, SeedSeriesBeginsAsGivenWithoutRepeats) {
    EXPECT_EQ(seed_of(329363537, 0), 329363537u);
    std::set<std::uint32_t> seen;
    for (std::uint32_t k = 0; k < 1000; ++k) seen.insert(seed_of(329363537, k));
    EXPECT_EQ(seen.size(), 1000u);
}

}  // namespace random_test
}  // namespace crescent
