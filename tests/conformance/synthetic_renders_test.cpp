// Moments of synthetic noise against their closed forms.
#include "tests/support/synthetic_renders.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compare/renders.h"

namespace crescent {
namespace synthetic_test {

using Kind = SyntheticNoise::Kind;
constexpr int side = 128;

/// Mean and variance over the pixels of one render.
Spread of_pixels(const SyntheticNoise& noise, std::uint32_t seed = 1) {
    std::vector<double> values;
    for (std::uint32_t i = 0; i < side * side; ++i) values.push_back(synthetic_pixel(noise, seed, i, side));
    return spread(values);
}

TEST(SyntheticNoise, HasMeanOneAndItsVariance) {
    // Sparks: 1/4 of each side, 0.1 / p bright with probability p.
    const std::pair<SyntheticNoise, double> kinds[] = {{{Kind::normal, 0.3}, 0.09}, {{Kind::gamma, 0.5}, 0.25},
        {{Kind::lognormal, 0.5}, std::exp(0.25) - 1}, {{Kind::hits, 0.05}, 0.95 / (16 * 0.05)},
        {{Kind::events, 0.05}, 0.02 * 0.02 + 2 * 0.01 / 0.05 - 0.01},
        {{Kind::sparks, 0.05}, 0.02 * 0.02 + (0.01 / 0.05 - 0.01) / 16}, {{Kind::pareto, 5}, 1.0 / 15}};
    for (const auto& [noise, variance] : kinds) {
        SCOPED_TRACE(to_string(noise));
        const Spread found = of_pixels(noise);
        EXPECT_NEAR(found.mean, 1, 4 * std::sqrt(variance) / side);
        EXPECT_NEAR(found.sd * found.sd / variance, 1, 0.15);
    }
}

TEST(SyntheticNoise, ABiasScalesEveryPixel) {
    for (const Kind kind : {Kind::gamma, Kind::hits, Kind::events})
        EXPECT_DOUBLE_EQ(
            synthetic_pixel({kind, 0.1, 0.25}, 3, 17, side), 1.25 * synthetic_pixel({kind, 0.1}, 3, 17, side));
}

TEST(SyntheticRenders, AHueKeepsTheLuminance) {
    SyntheticNoise noise{Kind::gamma, 0.2};
    noise.hue = 0.1;
    const Render r = synthetic_render("r", noise, 1, {.a = noise, .b = noise, .width = 8});
    for (std::uint32_t i = 0; i < r.size(); ++i) {
        EXPECT_NEAR(r.y(i), synthetic_pixel(noise, 1, i, 8), 1e-6);
        EXPECT_NEAR(r.r[i] / r.g[i], 1.1, 1e-6);
    }
}

TEST(SyntheticRenders, OwnNoiseFailuresAndFiltersAreAsStated) {
    SyntheticNoise noise{Kind::gamma, 0.2};
    const SyntheticScene coloured{.a = noise, .b = noise, .width = side, .own = 0.5};
    EXPECT_NE(synthetic_render("r", noise, 1, coloured).r, synthetic_render("r", noise, 1, coloured).b);
    noise.filter = 2;
    const Render filtered = synthetic_render("r", noise, 1, {.a = noise, .b = noise, .width = side});
    EXPECT_NEAR(spread(std::vector<double>(filtered.r.begin(), filtered.r.end())).sd, 0.1, 0.005);
    noise.filter = 1;
    noise.failing = 0.01;
    const Render failing = synthetic_render("r", noise, 1, {.a = noise, .b = noise, .width = side});
    EXPECT_NEAR(static_cast<double>(std::count_if(failing.g.begin(), failing.g.end(), [](float x) { return x != x; })),
        0.01 * side * side, 4 * std::sqrt(0.01) * side);
}

TEST(SyntheticScenes, KnowWhetherTheyHaveRareEvents) {
    SyntheticScene scene{{Kind::events, 1e-9}, {Kind::gamma, 0.2}, 2, 16};
    EXPECT_FALSE(have_events(scene, 1));
    scene.a.size = 0.5;
    EXPECT_TRUE(have_events(scene, 1));
    EXPECT_DOUBLE_EQ(event_size(scene.a), 0.2);
    EXPECT_EQ(event_size(scene.b), 0);
}

TEST(SyntheticScenes, EqualSeedsGiveEqualResults) {
    const SyntheticScene scene{{Kind::gamma, 0.2}, {Kind::gamma, 0.2}, 3, 16};
    const auto mean = [&](std::uint32_t seed) {
        return *compare_synthetic(scene, seed).arms[0].regions[0].metric("y_mean").value;
    };
    EXPECT_EQ(mean(1), mean(1));
    EXPECT_NE(mean(1), mean(2));
}

}  // namespace synthetic_test
}  // namespace crescent
