#include "display/turbo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace crescent {
namespace {

TEST(Turbo, Has_the_published_entries) {
    EXPECT_EQ(turbo(0), (Srgb8{48, 18, 59}));
    EXPECT_EQ(turbo(1 / 255.0), (Srgb8{50, 21, 67}));
    EXPECT_EQ(turbo(128 / 255.0), (Srgb8{164, 252, 60}));
    EXPECT_EQ(turbo(1), (Srgb8{122, 4, 3}));
}

// The degree-5 fit that was published beside the table (R. Du, A. Mikhailov, 2019) checks every row of it.
TEST(Turbo, Agrees_with_the_published_polynomial) {
    constexpr double fit[3][6] = {
        {0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943},
        {0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604},
        {0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973},
    };
    for (int i = 0; i < 256; ++i) {
        double t = i / 255.0;
        Srgb8 c = turbo(t);
        for (int k = 0; k < 3; ++k) {
            double p = 0;
            for (int d = 5; d >= 0; --d) p = p * t + fit[k][d];
            EXPECT_NEAR(c[std::size_t(k)] / 255.0, p, 0.06) << "entry " << i << ", channel " << k;
        }
    }
}

TEST(Turbo, Goes_in_small_steps_and_clamps) {
    for (int i = 1; i <= 2000; ++i) {
        Srgb8 a = turbo((i - 1) / 2000.0), b = turbo(i / 2000.0);
        for (std::size_t k = 0; k < 3; ++k) ASSERT_LE(std::abs(a[k] - b[k]), 2) << i;
    }
    EXPECT_EQ(turbo(-1), turbo(0));
    EXPECT_EQ(turbo(7), turbo(1));
    EXPECT_EQ(turbo(std::nan("")), not_a_number_colour);
}

}  // namespace
}  // namespace crescent
