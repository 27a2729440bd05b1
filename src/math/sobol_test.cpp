// Scrambled Sobol points are a (0, m, 2)-net in base 2 for every seed, and uniform over seeds.
#include "math/sobol.h"

#include <gtest/gtest.h>

#include <set>

namespace crescent::math {
namespace sobol_test {

TEST(Sobol, HasTheFirstPointsOfJoeAndKuo) {
    const double second[] = {0, 0.5, 0.75, 0.25, 0.625, 0.125, 0.375, 0.875};
    const double first[] = {0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875};
    for (std::uint32_t i = 0; i < 8; ++i) {
        EXPECT_EQ(reversed_bits(i) * 0x1p-32, first[i]) << i;
        const double y = sobol_second(i) * 0x1p-32;
        EXPECT_TRUE(std::set<double>(std::begin(second), std::end(second)).contains(y)) << i << " " << y;
    }
    EXPECT_EQ(sobol_second(1), 0x80000000u);
    EXPECT_EQ(sobol_second(2), 0xc0000000u);
    EXPECT_EQ(sobol_second(3), 0x40000000u);
    EXPECT_EQ(sobol_second(4), 0xa0000000u);
}

TEST(Sobol, FillsEveryElementaryIntervalOnceForAnySeed) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        const auto scramble = pcg4d(Vec4u<std::uint32_t>{seed, 1, 2, 3});
        for (int across = 0; across <= 8; ++across) {
            const int columns = 1 << across, rows = 256 / columns;
            std::set<std::pair<int, int>> cells;
            for (std::uint32_t i = 0; i < 256; ++i) {
                const Vec2<float> u = scrambled_sobol(i, scramble);
                EXPECT_TRUE(u.x > 0 && u.x < 1 && u.y > 0 && u.y < 1);
                cells.emplace(static_cast<int>(u.x * static_cast<float>(columns)),
                    static_cast<int>(u.y * static_cast<float>(rows)));
            }
            EXPECT_EQ(cells.size(), 256u) << seed << " " << columns << " x " << rows;
        }
    }
}

TEST(Sobol, IsUniformOverSeeds) {
    for (const std::uint32_t index : {0u, 1u, 6u, 1000u}) {
        double count[4][4] = {};
        const int seeds = 32000;
        for (std::uint32_t s = 0; s < seeds; ++s) {
            const Vec2<float> u = scrambled_sobol(index, pcg4d(Vec4u<std::uint32_t>{s, 77, 0, 5}));
            ++count[static_cast<int>(4 * u.x)][static_cast<int>(4 * u.y)];
        }
        double chi2 = 0;
        for (const auto& row : count)
            for (const double n : row) chi2 += (n - seeds / 16.0) * (n - seeds / 16.0) / (seeds / 16.0);
        EXPECT_LT(chi2, 45) << index;  // 15 degrees of freedom: p = 8e-5
    }
}

}  // namespace sobol_test
}  // namespace crescent::math
