// Streams of random numbers, Sobol nets and the chart of the sphere, compared with closed forms.
#include "check/estimate/stream.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace crescent::check {
namespace stream_test {

TEST(CheckStreams, KeysThatDifferInAnyFieldShareNoBlock) {
    const StreamKey base{7, 3, 0, 1, Purpose::draws, 2};
    std::vector<StreamKey> keys(7, base);
    keys[1].seed = 8;
    keys[2].place = 4;
    keys[3].technique = 1;
    keys[4].stage = 2;
    keys[5].purpose = Purpose::points;
    keys[6].part = 3;
    std::set<std::array<std::uint32_t, 4>> blocks;
    for (const StreamKey& key : keys)
        for (std::uint32_t i = 0; i < 4096; ++i) {
            const auto b = key.block(i);
            blocks.insert({b.x, b.y, b.z, b.w});
        }
    EXPECT_EQ(blocks.size(), keys.size() * 4096);
}

TEST(CheckStreams, NumbersDoNotRoundToOneInFloat) {
    EXPECT_LT(static_cast<float>(unit_number(0xffffffffu)), 1.0f);
    EXPECT_GT(unit_number(0), 0);
    EXPECT_EQ(single_number(unit_number(0)), 0x1p-24);
}

/// Largest number of points in a cell over all elementary intervals of one shape, for a net of 2^m points.
int most_in_a_cell(int d0, int d1, int bits0, int bits1, int m, std::uint32_t seed0, std::uint32_t seed1) {
    std::vector<int> count(std::size_t{1} << (bits0 + bits1));
    int most = 0;
    for (std::uint32_t i = 0; i < 1u << m; ++i) {
        const std::uint32_t x = owen_scrambled(sobol(i, d0), seed0), y = owen_scrambled(sobol(i, d1), seed1);
        const std::size_t cell = (bits0 ? x >> (32 - bits0) : 0u) << bits1 | (bits1 ? y >> (32 - bits1) : 0u);
        most = std::max(most, ++count[cell]);
    }
    return most;
}

TEST(CheckSobol, FirstTwoDimensionsAreANetWithOnePointInEachElementaryInterval) {
    constexpr int m = 10;
    for (int a = 0; a <= m; ++a) {
        EXPECT_EQ(most_in_a_cell(0, 1, a, m - a, m, 0, 0), 1) << a;
        EXPECT_EQ(most_in_a_cell(0, 1, a, m - a, m, 0x12345678u, 0x9abcdef1u), 1) << a;
    }
}

TEST(CheckSobol, ARunOfPointsHasEachPointOfTheSequence) {
    const ScrambledSobol points({7}, 5, Resolution::standard);
    std::vector<PrimarySample> run(700, PrimarySample(0.5, 0.5));
    for (PrimarySample& u : run) u[6] = 0.5;
    points.points(333, run);
    for (std::uint32_t i = 0; i < run.size(); ++i) {
        const PrimarySample one = points.at(333 + i);
        for (int d = 0; d < PrimarySample::most_numbers; ++d) EXPECT_EQ(run[i][d], one[d]) << i << " " << d;
    }
    Stream seeds(StreamKey{7});
    for (int d = 0; d < 5; ++d) EXPECT_EQ(run[100][d], unit_number(owen_scrambled(sobol(433, d), seeds.bits()))) << d;
}

TEST(CheckSobol, EveryDimensionHasOnePointInEachOfItsIntervals) {
    for (int d = 0; d < PrimarySample::most_numbers; ++d) EXPECT_EQ(most_in_a_cell(d, 0, 10, 0, 10, 77u, 0), 1) << d;
}

TEST(CheckSobol, PairsOfDimensionsHaveNoMoreThanEightPointsInACell) {  // t <= 3 of Joe and Kuo's first eight
    for (int a = 0; a < PrimarySample::most_numbers; ++a)
        for (int b = 0; b < a; ++b) EXPECT_LE(most_in_a_cell(a, b, 5, 5, 10, 1u, 2u), 8) << a << " " << b;
}

TEST(CheckChart, RoundTripIsExactToRounding) {
    for (double t : {1e-18, 1e-9, 0.3, 1.0, 1.7, 2 - 1e-9})
        for (double phi : {0.0, 1e-9, 2.0, 6.28}) {
            const ChartPoint back = to_chart(from_chart({t, phi}));
            EXPECT_NEAR(back.t, t, 4e-16 + 1e-15 * t);
            EXPECT_NEAR(back.phi, phi, 1e-12);
        }
}

TEST(CheckChart, AreaIsSolidAngle) {
    const ChartRect cap{0, 1 - std::cos(0.3), 0, two_pi};
    EXPECT_NEAR(cap.area(), two_pi * (1 - std::cos(0.3)), 1e-15);
    EXPECT_NEAR(cap.theta_width(), 0.3, 1e-14);
}

TEST(RandomNumbers, HaveTheirResolution) {
    const StreamKey key{5};
    bool finer = false;
    for (std::uint32_t i = 0; i < 100; ++i) {
        const PrimarySample single = numbers_at(key, i, 5, Resolution::single),
                            standard = numbers_at(key, i, 5, Resolution::standard),
                            fine = numbers_at(key, i, 5, Resolution::fine);
        for (int k = 0; k < 5; ++k) {
            EXPECT_EQ(std::fmod(single[k] * 0x1p24, 2), 1);
            EXPECT_NEAR(fine[k], standard[k], 0x1p-31);
            EXPECT_EQ(std::fmod(std::floor(fine[k] * 0x1p53), 2), 1);
            finer = finer || std::fmod(fine[k] * 0x1p33, 1) != 0;
        }
    }
    EXPECT_TRUE(finer);
    const ScrambledSobol points({7}, 2, Resolution::fine);
    EXPECT_NE(std::fmod(points.at(1)[0] * 0x1p33, 1), 0);
}

}  // namespace stream_test
}  // namespace crescent::check
