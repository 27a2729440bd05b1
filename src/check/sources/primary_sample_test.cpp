// Random numbers of samplers under test, and an even cover of their cube.
#include "check/sources/primary_sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/simd/random.h"

namespace crescent::inline sources {
namespace {

TEST(DrawnNumbers, AreThoseOfTheEstimator) {
    const PrimarySample u = drawn_numbers(7, 3, 11, 0, 2);
    EXPECT_EQ(u.x, static_cast<double>(draw(7, 3, 11).x));
    EXPECT_EQ(u.y, static_cast<double>(draw(7, 3, 11).y));
    const PrimarySample eight = drawn_numbers(7, 3, 11, 0, 8);
    EXPECT_EQ(eight.x, u.x);
    for (int a = 0; a < 8; ++a)
        for (int b = 0; b < a; ++b) EXPECT_NE(eight[a], eight[b]);
    EXPECT_NE(drawn_numbers(7, 3, 11, 1, 2).x, u.x);  // of another technique
    for (int k = 0; k < 8; ++k) EXPECT_EQ(std::fmod(eight[k] * 0x1p24, 1), 0);
}

TEST(EvenCover, FillsEveryIntervalOfEachNumber) {
    for (const int count : {1, 2, 3, 8})
        for (int k = 0; k < count; ++k) {
            std::vector<double> x;
            for (std::uint64_t i = 0; i < 512; ++i) x.push_back(even_cover(i, {}, count)[k]);
            std::sort(x.begin(), x.end());
            double gap = x.front() + 1 - x.back();
            for (std::size_t i = 1; i < x.size(); ++i) gap = std::max(gap, x[i] - x[i - 1]);
            EXPECT_LT(gap, 12.0 / 512) << count << " " << k;  // of random numbers: ln 512 + a few
        }
}

TEST(EvenCover, IsShiftedAndBelowOne) {
    PrimarySample shift(0.25, 0.999999999);
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const PrimarySample at = even_cover(i, shift, 2), from = even_cover(i, {}, 2);
        EXPECT_NEAR(std::fmod(at.x - from.x + 1, 1), 0.25, 1e-9);
        for (const double x : {at.x, at.y}) EXPECT_TRUE(x >= 0 && x <= 1 - 0x1p-24);
    }
}

TEST(DescribedNumbers, AreAsManyAsTheSamplerTakes) {
    PrimarySample u(0, 0.5);
    u[2] = 0.125;
    EXPECT_EQ(describe(u, 2), "u = (0, 0.5)");
    EXPECT_EQ(describe(u, 3), "u = (0, 0.5, 0.125)");
}

}  // namespace
}  // namespace crescent::inline sources
