// The two sides of a test of means: noise of sets of pixels, and differences that the tests cannot detect.
#include "compare/wording.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/memory_renders.h"

namespace crescent {
namespace wording_test {

TEST(MeanAndError, OfOneValueHasNoError) {
    const std::vector<double> four{1, 2, 3, 4};
    EXPECT_DOUBLE_EQ(mean_and_error(four).mean, 2.5);
    EXPECT_DOUBLE_EQ(mean_and_error(four).se, std::sqrt(5.0 / 3 / 4));
    EXPECT_TRUE(std::isnan(mean_and_error(std::span(four).first(1)).se));
    EXPECT_TRUE(std::isnan(mean_and_error({}).mean));
}

/// Four renders of each of two arms of two pixels.
struct FourRenders {
    explicit FourRenders(const std::vector<CompareFlag>& flags = {}) {
        for (int k = 0; k < 4; ++k) {
            const auto x = static_cast<float>(k);
            renders.put_grey("a" + std::to_string(k), 2, {1 + x, 5});             // variance 5/3 and 0
            renders.put_grey("b" + std::to_string(k), 2, {2 * x, 4 + x * 0.5f});  // 20/3 and 5/12
        }
        plan = renders.plan(flags);
        all = renders.read(flags);
        measured = renders.compare(flags);
    }
    BiasPair pair() const { return {plan, all, measured, 0, 1}; }
    MemoryRenders renders;
    ComparePlan plan;
    RenderStats all;
    CompareResult measured;
};

TEST(TwoSides, HaveTheNoiseOfTheirPixels) {
    const FourRenders four;
    const SetVariance all = four.pair().noise_of(four.all.frame()), first = four.pair().noise_of(Box{0, 0, 0, 0});
    EXPECT_EQ(all.pixels, 2);
    EXPECT_NEAR(all.a, 5.0 / 6, 1e-6);
    EXPECT_NEAR(all.b, (20.0 / 3 + 5.0 / 12) / 2, 1e-6);
    EXPECT_NEAR(all.unpaired_variance, all.a + all.b, 1e-12);
    EXPECT_NEAR(all.mean_a, (2.5 + 5) / 2, 1e-6);
    EXPECT_NEAR(first.b, 20.0 / 3, 1e-6);
    EXPECT_NEAR(four.pair().noise_of(four.all.regions[0]).b, all.b, 1e-12);
}

TEST(TwoSides, AreTestedByWelchWithAFloorForTheNoise) {
    const FourRenders four;
    const std::vector<double> a{1, 2, 3, 4}, b{5, 5, 5, 5};
    const SetVariance noise{1, 100, 100, 200, 0, 0};
    const Welch plain = four.pair().test(a, b, noise, false), floored = four.pair().test(a, b, noise, true);
    EXPECT_NEAR(plain.se, std::sqrt(5.0 / 12), 1e-12);
    EXPECT_NEAR(plain.df, 3, 1e-9);
    EXPECT_NEAR(floored.se, std::sqrt(50), 1e-9);
}

TEST(TwoSides, RareEventsMayHideADifference) {
    const FourRenders four({{{"brightest"}, "1000", true, ""}});
    // Among 100 pixels of 4 renders at most -ln(1/e) / 400 of the pixels have an event that none shows.
    EXPECT_NEAR(four.pair().missable_difference(1, 100, std::exp(-1)), 1000 / 400.0, 1e-9);
    EXPECT_NEAR(four.pair().missable_difference(1, 100, std::exp(-2)), 2000 / 400.0, 1e-9);
    const auto events = four.pair().events_for({{}, 1, 1.5, 0, 0}, 100, std::exp(-1));
    ASSERT_TRUE(events);
    EXPECT_EQ(events->arm, "a");
    EXPECT_NEAR(events->one_in, 400, 1e-9);
    EXPECT_NEAR(events->size, 0.5 * 400, 1e-9);
    EXPECT_NEAR(events->of_mean, 200, 1e-9);
    EXPECT_EQ(four.pair().events_for({{}, 3, 1.5, 0, 0}, 100, 0.1)->arm, "b");
}

TEST(TwoSides, RoundingLimitsWhatIsDetected) {
    FourRenders four;
    four.all.arms[0].film.rounding = four.all.arms[1].film.rounding = 0x1p-11;
    const auto seen = [&](double pixels, double variance) {
        return four.pair().undetectable_difference(1, 1, pixels, variance, 1);  // level 1: without rare events
    };
    EXPECT_DOUBLE_EQ(seen(1, 0), 4 * 2 * 0x1p-11);
    EXPECT_DOUBLE_EQ(seen(10000, 0), 4 * 2 * 0x1p-11);  // without noise every pixel is rounded the same way
    EXPECT_DOUBLE_EQ(seen(10000, 1), 4 * 2 * 0x1p-11 / 100);
}

TEST(TwoSides, OnePixelThatDecidesATileIsFound) {
    FourRenders four;
    EXPECT_FALSE(four.pair().lone_pixel_in(0));
    four.all.arms[0].quantities[0].tiles[2][0].largest = 1e3;
    EXPECT_TRUE(four.pair().lone_pixel_in(0));
}

TEST(WhatWasFound, HasTheSentenceOfTheResultOnceInTheSummary) {
    CompareResult result;
    for (const char* sentence : {"A differs from B.", "A differs from C."}) {
        BiasResult& bias = result.bias.emplace_back();
        bias.sentence = sentence;
        bias.regions.emplace_back().differs = true;
    }
    EXPECT_EQ(found_about_means(result).size(), 2u);
    result.stated_pair = 1;
    EXPECT_EQ(found_about_means(result, false), std::vector<std::string>{"A differs from B."});
    EXPECT_EQ(found_about_means(result).size(), 2u);
}

TEST(Roughness, IsTheErrorOfAReferenceOfOneFile) {
    RenderStats all;
    all.width = 4;
    all.height = 1;
    all.bad.assign(4, false);
    ArmStats arm;
    arm.film.count = 2;
    arm.film.planes = {{{1, 2, 1, 2}, {0, 0, 0, 0}}};
    all.reference.emplace();
    all.reference->film.count = 1;
    all.reference->film.planes = {{{0, 0, 0, 0}, {0, 0, 0, 0}}};
    PixelSet set;
    set.pixels = {0, 1, 2, 3};
    EXPECT_DOUBLE_EQ(roughness(all, arm, set), 0.5);
    arm.film.planes[0].m2.assign(4, 0.5);  // the arm's own variance 0.5 over 2 renders
    EXPECT_DOUBLE_EQ(roughness(all, arm, set), 0.25);
    arm.film.planes[0].mean = {1, 1, 1, 1};  // a constant bias is smooth
    EXPECT_DOUBLE_EQ(roughness(all, arm, set), 0);
}

}  // namespace wording_test
}  // namespace crescent
