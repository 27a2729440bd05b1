// sRGB against values of the standard, bytes against the rounded encoding; Neutral against values computed from its
// specification, monotonic greys and constant hues; photographs of NaN, infinite and negative radiance.
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "output/tone_map.h"

namespace crescent {

namespace tone_map_test {

TEST(Srgb, EncodesTheValuesOfTheStandard) {
    EXPECT_NEAR(srgb_encode(0.5), 0.735356983, 1e-9);
    EXPECT_NEAR(srgb_encode(0.18), 0.461356130, 1e-9);
    EXPECT_NEAR(srgb_decode(0.5), 0.214041140, 1e-9);
    EXPECT_DOUBLE_EQ(srgb_encode(0), 0);
    EXPECT_DOUBLE_EQ(srgb_encode(1), 1);
}

TEST(Srgb, ItsTwoPiecesMeetAt0031308) {
    double below = srgb_encode(0.0031308), above = srgb_encode(std::nextafter(0.0031308, 1.0));
    EXPECT_NEAR(below, 0.0404499, 1e-7);
    EXPECT_NEAR(above, below, 1e-7);
}

TEST(Srgb, DecodingUndoesEncodingAndBothClamp) {
    for (int i = 0; i <= 1000; ++i) EXPECT_NEAR(srgb_decode(srgb_encode(i / 1000.0)), i / 1000.0, 1e-7);
    EXPECT_DOUBLE_EQ(srgb_encode(-3), 0);
    EXPECT_DOUBLE_EQ(srgb_encode(3), 1);
}

TEST(Srgb, AByteIsTheRoundedEncoding) {
    for (int i = -10; i <= 100010; ++i) {
        double x = i / 100000.0;
        ASSERT_EQ(int(srgb_byte(x)), int(std::lround(255 * srgb_encode(x)))) << x;
    }
    EXPECT_EQ(srgb_byte(std::nan("")), 0);
}

TEST(Neutral, SubtractsFourPerCentBelowCompression) {
    Rgb out = neutral({0.5, 0.3, 0.2});
    EXPECT_DOUBLE_EQ(out[0], 0.46);
    EXPECT_DOUBLE_EQ(out[1], 0.26);
    EXPECT_DOUBLE_EQ(out[2], 0.16);
    EXPECT_NEAR(neutral({0.8, 0.8, 0.8})[0], 0.76, 1e-12);
}

TEST(Neutral, ToeIsAParabolaUpToEightPerCent) {
    EXPECT_DOUBLE_EQ(neutral({0, 0, 0})[0], 0);
    EXPECT_NEAR(neutral({0.04, 0.04, 0.04})[0], 0.01, 1e-12);  // 6.25 x^2
    EXPECT_NEAR(neutral({0.08, 0.08, 0.08})[0], 0.04, 1e-12);
    EXPECT_NEAR(neutral({0.0799999, 0.08, 0.08})[1], 0.04, 1e-6);
}

TEST(Neutral, CompressesAsTheSpecificationComputes) {
    EXPECT_NEAR(neutral({1, 1, 1})[1], 1 - 0.0576 / 0.44, 1e-12);
    Rgb red = neutral({1, 0, 0});  // new peak 0.88, white by 1 - 1/(0.15 * 0.12 + 1)
    EXPECT_NEAR(red[0], 0.88, 1e-12);
    EXPECT_NEAR(red[1], 0.88 * (1 - 1 / 1.018), 1e-12);
    EXPECT_DOUBLE_EQ(red[1], red[2]);
}

TEST(Neutral, GreysRiseTowardsOneAndNeverReachPastIt) {
    double last = -1;
    for (double x = 0; x < 1000; x = x * 1.01 + 1e-3) {
        double y = neutral({x, x, x})[0];
        ASSERT_GT(y, last) << x;
        ASSERT_LT(y, 1) << x;
        last = y;
    }
    EXPECT_GT(neutral({1e6, 0, 0})[1], 0.999);  // far above white every colour is white
}

TEST(Neutral, KeepsTheHue) {
    Rgb in{4.0, 2.0, 0.5}, out = neutral(in);
    EXPECT_NEAR((out[1] - out[2]) / (out[0] - out[2]), (in[1] - in[2]) / (in[0] - in[2]), 1e-12);
}

TEST(Photograph, IsExposureThenNeutralThenSrgb) {
    Srgb8 c = photograph({0.25, 0.15, 0.1}, 2);
    EXPECT_EQ(c[0], std::lround(255 * srgb_encode(0.46)));
    EXPECT_EQ(c[2], std::lround(255 * srgb_encode(0.16)));
}

TEST(Photograph, NaNIsMagentaAndNegativeLightIsZero) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(photograph({0, std::nan(""), 0}, 1), not_a_number_colour);
    EXPECT_EQ(photograph({0, 0, inf}, 1), not_a_number_colour);
    EXPECT_EQ(photograph({-1, -1, -1}, 1), (Srgb8{0, 0, 0}));
}

}  // namespace tone_map_test

// ---- Eleven published entries; all 256 by their second differences, at most 2; small steps between, both ends, NaN.

namespace tone_map_test {

TEST(Turbo, HasThePublishedEntries) {
    struct {
        int entry;
        Srgb8 colour;
    } published[] = {{0, {48, 18, 59}}, {1, {50, 21, 67}}, {16, {64, 64, 162}}, {32, {70, 107, 227}},
        {64, {40, 188, 235}}, {96, {50, 242, 152}}, {128, {164, 252, 60}}, {160, {238, 207, 58}}, {192, {251, 126, 33}},
        {224, {208, 47, 5}}, {255, {122, 4, 3}}};
    for (const auto& p : published) EXPECT_EQ(turbo(p.entry / 255.0), p.colour) << "entry " << p.entry;
}

// A wrong digit in any of the 768 bytes changes the second difference by more than rounding does.
TEST(Turbo, BendsNoMoreThanRoundingAllows) {
    for (int i = 1; i < 255; ++i) {
        Srgb8 a = turbo((i - 1) / 255.0), b = turbo(i / 255.0), c = turbo((i + 1) / 255.0);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(std::abs(a[k] - 2 * b[k] + c[k]), 2) << "entry " << i;
    }
}

TEST(Turbo, GoesInSmallStepsAndClamps) {
    for (int i = 1; i <= 2000; ++i) {
        Srgb8 a = turbo((i - 1) / 2000.0), b = turbo(i / 2000.0);
        for (std::size_t k = 0; k < 3; ++k) ASSERT_LE(std::abs(a[k] - b[k]), 2) << i;
    }
    EXPECT_EQ(turbo(-1), turbo(0));
    EXPECT_EQ(turbo(7), turbo(1));
    EXPECT_EQ(turbo(std::nan("")), not_a_number_colour);
}

}  // namespace tone_map_test

}  // namespace crescent
