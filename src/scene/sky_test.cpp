// The sampler of a sky against its own density and its image.
#include "scene/sky.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/functions.h"
#include "math/simd/scalar.h"
#include "tests/support/skies.h"

namespace crescent {
namespace sky_test {

using testing::HasSubstr;

TEST(SkyTable, HasSolidAnglesOfASphere) {
    for (const int height : {1, 2, 5, 8, 63, 4096}) {
        std::vector<float> rgb(6 * std::size_t(height) * std::size_t(height), 1.0f);
        const SkyTable sky(test::sky_of(2 * height, std::move(rgb)));
        double sum = 0;
        for (int row = 0; row < height; ++row) sum += sky.solid_angle(row) * sky.width();
        EXPECT_NEAR(sum / (4 * pi), 1, 1e-13) << height;
    }
}

TEST(SkyTable, HasADensityThatIntegratesToOne) {
    for (const int height : {1, 3, 16, 101}) {
        const SkyTable sky(test::noisy_sky(height, 7));
        double sum = 0;
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < sky.width(); ++column)
                sum += sky.pdf(static_cast<std::uint32_t>(row * sky.width() + column)) * sky.solid_angle(row);
        EXPECT_NEAR(sum, 1, 1e-12) << height;
    }
}

TEST(SkyTable, DrawsDirectionsOfTheDrawnTexel) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> number(0, 1);
    for (const int height : {1, 2, 3, 17, 512}) {
        SkyLight light = test::noisy_sky(height, 11);
        light.rotation = -73;
        const SkyTable sky(light);
        int elsewhere = 0;
        for (int k = 0; k < 20000; ++k) {
            const SkyDraw drawn = sky.sample(number(random), number(random));
            EXPECT_NEAR(dot(drawn.w, drawn.w), 1, 1e-14);
            EXPECT_EQ(drawn.pdf, sky.pdf(drawn.texel));
            EXPECT_GT(drawn.pdf, 0);
            elsewhere += sky.texel_at(drawn.w) != drawn.texel;
        }
        EXPECT_LE(elsewhere, 1) << height;  // on an edge
    }
}

/// The tables and the fast azimuth only begin the searches: texels are those of a plain search.
TEST(SkyTable, HasTheTexelsOfAPlainSearch) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> number(0, 1), coordinate(-1, 1);
    for (const int height : {1, 2, 3, 17, 2048}) {
        SkyLight light = test::noisy_sky(height, 11);
        light.rotation = 31;
        const SkyTable sky(light);
        std::vector<double> edge;  // 1 - cos theta, down to the equator
        for (int row = 0; 2 * row <= height; ++row) edge.push_back(2 * sqr(math::sin(pi * row / (2.0 * height))));
        if (height % 2 == 0) edge.back() = 1;
        const auto plain = [&](Vec3d w) {
            const double across2 = w.x * w.x + w.z * w.z, size = std::sqrt(across2 + w.y * w.y),
                         h = across2 / (size * (size + std::fabs(w.y)));
            int row = 0;
            while (row + 1 < int(edge.size()) && row < (height - 1) / 2 && edge[std::size_t(row) + 1] <= h) ++row;
            if (w.y < 0) row = height - 1 - row;
            double turn = math::atan2(w.x, -w.z) / (2 * pi) + light.rotation / 360;
            turn -= std::floor(turn);
            return row * sky.width() + std::min(int(turn * sky.width()), sky.width() - 1);
        };
        for (int k = 0; k < 20000; ++k) {
            const double small = k % 4 == 0 ? 1e-9 : 1, low = k % 8 == 0 ? 0 : 1;
            Vec3d w = {small * coordinate(random), coordinate(random), coordinate(random)};
            EXPECT_EQ(int(sky.texel_at(w)), plain(w)) << height;
            w.z = 0;
            w.y *= low;
            EXPECT_EQ(int(sky.texel_at(w)), plain(w)) << height;
            // On the edge of a column, within rounding, and on that of a row.
            const double turn = std::floor(number(random) * sky.width()) / sky.width() - light.rotation / 360;
            const math::SinCos phi = math::sincos(2 * pi * turn);
            w = {phi.sin, coordinate(random), -phi.cos};
            EXPECT_EQ(int(sky.texel_at(w)), plain(w)) << height;
            const math::SinCos theta = math::sincos(pi * std::floor(number(random) * height) / height);
            w = {theta.sin * phi.sin, theta.cos, -theta.sin * phi.cos};
            EXPECT_EQ(int(sky.texel_at(w)), plain(w)) << height;
        }
    }
}

/// Chi-square of texels against their masses, and of the place within a texel.
TEST(SkyTable, DrawsTexelsByMassAndDirectionsEvenly) {
    const SkyTable sky(test::noisy_sky(4, 5));
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> number(0, 1);
    const std::size_t texels = 32;
    const int draws = 400000;
    std::vector<double> count(texels), sum_y(texels);
    for (int k = 0; k < draws; ++k) {
        const SkyDraw drawn = sky.sample(number(random), number(random));
        ++count[drawn.texel];
        sum_y[drawn.texel] += drawn.w.y;
    }
    double chi2 = 0;
    for (std::size_t t = 0; t < texels; ++t) {
        const int row = static_cast<int>(t) / sky.width();
        const double expected = draws * sky.pdf(static_cast<std::uint32_t>(t)) * sky.solid_angle(row);
        if (expected == 0) {
            EXPECT_EQ(count[t], 0);
            continue;
        }
        chi2 += (count[t] - expected) * (count[t] - expected) / expected;
        const double top = std::cos(pi * row / 4), bottom = std::cos(pi * (row + 1) / 4);
        EXPECT_NEAR(sum_y[t] / count[t], 0.5 * (top + bottom), 6 * (top - bottom) / std::sqrt(12 * count[t])) << t;
    }
    EXPECT_LT(chi2, 75);  // 31 degrees of freedom: p = 2e-5
}

TEST(SkyTable, KeepsToItsConvention) {
    std::vector<float> rgb(3 * 8 * 4, 1.0f);
    SkyLight light = test::sky_of(8, std::move(rgb));
    const auto column = [&](Vec3d w) { return SkyTable(light).texel_at(w) % 8; };
    const auto row = [&](Vec3d w) { return SkyTable(light).texel_at(w) / 8; };
    EXPECT_EQ(row({0.1, 1, 0.1}), 0u);
    EXPECT_EQ(row({0.1, -1, 0.1}), 3u);
    EXPECT_EQ(column({0.01, 0, -1}), 0u);   // -z: the left edge
    EXPECT_EQ(column({-0.01, 0, -1}), 7u);  // and the right one
    EXPECT_EQ(column({1, 0, 0.01}), 2u);    // +x: a quarter
    EXPECT_EQ(column({0.01, 0, 1}), 3u);
    EXPECT_EQ(column({-0.01, 0, 1}), 4u);  // +z: the middle
    light.rotation = 90;                   // what was at -z is at -x: counterclockwise seen from above
    EXPECT_EQ(column({-1, 0, -0.01}), 0u);
    EXPECT_EQ(column({-1, 0, 0.01}), 7u);
}

TEST(SkyTable, TurnsDrawsWithTheSky) {
    SkyLight light = test::noisy_sky(16, 2);
    const SkyTable plain(light);
    light.rotation = 37;
    const SkyTable turned(light);
    const double sin = std::sin(37 * pi / 180), cos = std::cos(37 * pi / 180);
    for (double u = 0.05; u < 1; u += 0.1) {
        const SkyDraw a = plain.sample(u, 1 - u), b = turned.sample(u, 1 - u);
        EXPECT_EQ(a.texel, b.texel);
        EXPECT_NEAR(b.w.x, a.w.x * cos + a.w.z * sin, 1e-12);
        EXPECT_NEAR(b.w.z, -a.w.x * sin + a.w.z * cos, 1e-12);
    }
}

TEST(Skies, MayHaveAThousandthOfNegativeEnergy) {
    // By solid angle, the 94 other numbers weigh 60.9, and one next to the equator 0.924: a thousandth is 0.066.
    for (const float sum : {0.06f, 0.07f}) {
        RgbImage image = *test::sky_of(8, std::vector<float>(3 * 8 * 4, 1.0f)).image;
        image.rgb[3 * (8 * 2 + 5) + 1] = -0.9f * sum;
        image.rgb[3 * (8 * 2 + 6)] = -0.1f * sum;
        const bool is_little = sum < 0.065f;
        EXPECT_EQ(raise_to_zero(image), is_little ? 2u : 0u) << sum;
        const std::string why = why_no_sky(image, 1);
        EXPECT_EQ(why.find("texel (5, 2)") != why.npos, !is_little) << why;
    }
    for (const float x : {std::nanf(""), -HUGE_VALF}) {
        RgbImage image = *test::sky_of(8, std::vector<float>(3 * 8 * 4, 1.0f)).image;
        image.rgb[3 * (8 * 2 + 5)] = x;
        image.rgb[0] = -1e-6f;
        raise_to_zero(image);
        const std::string why = why_no_sky(image, 1);
        EXPECT_NE(why.find("texel (5, 2)"), why.npos) << why;
    }
}

TEST(Skies, AreRefusedWithTheTexel) {
    const auto why = [](float value, double scale = 1) {
        std::vector<float> rgb(3 * 8 * 4, 1.0f);
        rgb[3 * (8 * 2 + 5) + 1] = value;
        return why_no_sky(*test::sky_of(8, std::move(rgb)).image, scale);
    };
    EXPECT_EQ(why(2), "");
    for (const float bad : {-1e-30f, std::nanf(""), HUGE_VALF, 2e9f}) EXPECT_THAT(why(bad), HasSubstr("texel (5, 2)"));
    EXPECT_THAT(why(2e6f, 1e3), HasSubstr("texel (5, 2)"));
    EXPECT_THAT(why_no_sky(*test::sky_of(8, std::vector<float>(96)).image, 1), HasSubstr("every texel is 0"));
    RgbImage square;
    square.width = square.height = 8;
    square.rgb.assign(192, 1.0f);
    EXPECT_THAT(why_no_sky(square, 1), HasSubstr("8 x 8"));
}

}  // namespace sky_test
}  // namespace crescent
