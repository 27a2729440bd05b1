// Blocks against photograph() of single pixels and of averages computed by hand: whole-number enlargement, rows
// top-down, areas in linear light, constants at any ratio, one NaN at any size; and the results of fit() and inside().
#include "report/plates/raster.h"

#include <gtest/gtest.h>

#include <cmath>

namespace crescent::plates {
namespace raster_test {

Film ramp(int w, int h) {
    Film f(w, h, 1);
    for (int i = 0; i < w * h; ++i)
        f.r[std::size_t(i)] = f.g[std::size_t(i)] = f.b[std::size_t(i)] = f.y[std::size_t(i)] = float(i % 7) * 0.05f;
    return f;
}

Srgb8 pixel(const Block& b, int x, int y) {
    const unsigned char* p = &b.rgb[3 * (std::size_t(y) * std::size_t(b.width) + std::size_t(x))];
    return {p[0], p[1], p[2]};
}

TEST(Fit, EnlargesByIntegersAndReducesToTheSlot) {
    EXPECT_EQ(fit(100, 50, 350, 400).times, 3);
    EXPECT_EQ(fit(100, 50, 100, 50).times, 1);
    EXPECT_FALSE(fit(100, 50, 100, 50).reduced);
    Fit f = fit(960, 540, 392, 482);
    EXPECT_TRUE(f.reduced);
    EXPECT_EQ(f.out_w, 392);
    EXPECT_NEAR(f.out_h, 220.5, 0.51);
    EXPECT_EQ(fit(100, 4000, 500, 500).out_h, 500);
    EXPECT_EQ(fit(1, 16384, 500, 500).out_w, 1);
}

TEST(PhotographBlock, RepeatsEachPixelAndTurnsRowsTopDown) {
    Film f = ramp(5, 4);
    Block b = photograph_block(view(&f), {0, 0, 4, 3}, fit(5, 4, 15, 12), 1);
    ASSERT_EQ(b.width, 15);
    for (int y = 0; y < 12; ++y) {
        for (int x = 0; x < 15; ++x) {
            double v = f.r[std::size_t((3 - y / 3) * 5 + x / 3)];
            EXPECT_EQ(pixel(b, x, y), photograph({v, v, v}, 1));
        }
    }
}

TEST(PhotographBlock, AveragesAreasInLinearLight) {
    Film f(4, 4, 1);
    for (auto* plane : {&f.r, &f.g, &f.b}) {
        plane->assign(16, 0.0f);
        (*plane)[5] = 1.6f;
    }  // one pixel in four of a quarter
    Block b = photograph_block(view(&f), {0, 0, 3, 3}, fit(4, 4, 2, 2), 1);
    EXPECT_EQ(pixel(b, 0, 1), photograph({0.4, 0.4, 0.4}, 1));
    EXPECT_EQ(pixel(b, 1, 1), (Srgb8{0, 0, 0}));
}

TEST(PhotographBlock, AConstantStaysConstantAtAnyRatio) {
    Film f(37, 53, 1);
    for (auto* plane : {&f.r, &f.g, &f.b}) plane->assign(f.size(), 0.3f);
    for (int to : {1, 2, 7, 13, 36}) {
        Block b = photograph_block(view(&f), {0, 0, 36, 52}, fit(37, 53, to, to), 1);
        Srgb8 expected = photograph({0.3f, 0.3f, 0.3f}, 1);
        for (int y = 0; y < b.height; ++y) {
            for (int x = 0; x < b.width; ++x) ASSERT_EQ(pixel(b, x, y), expected) << to << ": " << x << ' ' << y;
        }
    }
}

TEST(PhotographBlock, OnePixelThatIsNotANumberShowsAtAnySize) {
    Film f = ramp(40, 40);
    f.g[std::size_t(11 * 40 + 23)] = std::nanf("");
    View v = view(&f);
    EXPECT_EQ(not_finite(v, whole(v)), 1u);
    for (double slot : {10.0, 40.0, 80.0}) {
        Block b = photograph_block(v, whole(v), fit(40, 40, slot, slot), 1);
        int shown = 0;
        for (int i = 0; i < b.width * b.height; ++i) shown += pixel(b, i % b.width, i / b.width) == not_a_number_colour;
        EXPECT_EQ(shown, slot < 41 ? 1 : 4) << slot;
    }
}

TEST(Inside, CutsABoxToTheImage) {
    Film f(10, 6, 1);
    Box b = inside({-5, 2, 20, 90}, view(&f));
    EXPECT_EQ(b.x0, 0);
    EXPECT_EQ(b.x1, 9);
    EXPECT_EQ(b.y0, 2);
    EXPECT_EQ(b.y1, 5);
}

}  // namespace raster_test
}  // namespace crescent::plates
