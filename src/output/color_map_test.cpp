// Eleven published entries; all 256 by their second differences, at most 2; small steps between, both ends, NaN.
#include <cmath>
#include <gtest/gtest.h>

#include "output/color_map.h"

namespace crescent::inline output {
namespace {

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

}  // namespace
}  // namespace crescent::inline output
