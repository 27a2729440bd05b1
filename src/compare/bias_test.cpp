// Tests which differences are found, and by which test: values that are not finite, channels, equal seeds, identical
// files.
#include "compare/bias.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "compare/plan.h"
#include "compare/shared_seeds.h"
#include "tests/support/memory_renders.h"

namespace crescent {
namespace bias_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Kind = SyntheticNoise::Kind;
using State = CompareResult::State;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
const CompareFlag same{{"expect"}, "same", false, ""}, wide{{"smallest"}, "0.5", true, ""},
    loose{{"alpha"}, "0.05", true, ""};

/// Returns two arms with this number of renders.
MemoryRenders arms(int renders, int side = 16) {
    MemoryRenders out;
    for (int k = 0; k < renders; ++k)
        for (const char arm : {'a', 'b'})
            out.put(std::string(1, arm) + std::to_string(10 + k), static_cast<std::uint32_t>(1000 * arm + k), side);
    return out;
}

/// Sets a pixel to a value in the first `renders` renders of an arm.
void set_pixel(MemoryRenders& of, char arm, std::size_t pixel, int renders, float value = nan) {
    for (auto& [name, render] : of.renders)
        if (name[0] == arm && renders-- > 0) render.g[pixel] = value;
}

TEST(NonFinite, PixelsInEveryRenderOfOneSideAndInNoneOfTheOtherAreADifference) {
    for (const int renders : {1, 2, 4, 24}) {
        for (const float value : {nan, INFINITY, -INFINITY}) {
            MemoryRenders m = arms(renders);
            for (const std::size_t i : {35, 36, 52}) set_pixel(m, 'b', i, renders, value);
            const CompareResult r = m.compare({same, wide});
            EXPECT_EQ(r.state, State::fails) << renders;
            const NonFinite& found = r.bias[0].non_finite;  // of b against a
            EXPECT_THAT(found.a.pixels, ElementsAre(35, 36, 52));
            EXPECT_TRUE(found.b.pixels.empty());
            EXPECT_EQ(found.a.least_renders, static_cast<std::uint32_t>(renders));
            EXPECT_EQ(found.a.most_other_renders, 0u);
            EXPECT_THAT(r.sentence, HasSubstr("3 pixels of b are not finite"));
            EXPECT_THAT(r.sentence, HasSubstr("(3, 2), (4, 2), (4, 3)"));
        }
    }
}

TEST(NonFinite, PixelsOnBothSidesAreLeftOutAndReported) {
    MemoryRenders m = arms(8);
    for (const char arm : {'a', 'b'}) set_pixel(m, arm, 35, 8);
    const CompareResult r = m.compare({same, wide});
    EXPECT_EQ(r.state, State::holds) << r.sentence;
    EXPECT_EQ(r.bias[0].non_finite.two_sided, 1u);
    EXPECT_THAT(r.bias[0].sentence, HasSubstr("1 pixel not finite on both sides is left out."));
}

TEST(NonFinite, PixelsInSomeRendersOfOneSideAreADifferenceIfEqualRatesAreUnlikely) {
    // Fisher's exact p of 12 of 24 against 0 of 24 is 8e-5, of 1 against 0 it is 1; of 3 of 4 against 0 of 4 it is
    // 0.14.
    for (const auto& [renders, of, state] :
        {std::tuple(12, 24, State::fails), {1, 24, State::holds}, {3, 4, State::inconclusive}, {1, 4, State::holds}}) {
        MemoryRenders m = arms(of);
        set_pixel(m, 'a', 35, renders);
        const CompareResult r = m.compare({same, wide});
        EXPECT_EQ(r.state, state) << renders << r.sentence;
        EXPECT_EQ(r.bias[0].non_finite.b.pixels.size(), state == State::fails ? 1u : 0u);
        EXPECT_EQ(r.bias[0].non_finite.one_sided, state == State::fails ? 0u : 1u);
    }
}

TEST(NonFinite, ScatteredPixelsDifferOnlyIfTheyAreOnOneSide) {
    SyntheticScene one{{Kind::gamma, 0.2}, {Kind::gamma, 0.2}, 8, 32, false}, both = one;
    one.b.failing = both.a.failing = both.b.failing = 3e-3;  // about 25 pixels in 8 renders
    int alarms = 0;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        const CompareResult found = compare_synthetic(one, seed);
        EXPECT_TRUE(found.bias[0].non_finite.differs()) << found.bias[0].sentence;
        alarms += compare_synthetic(both, seed).bias[0].non_finite.differs();
    }
    EXPECT_LE(alarms, 4);  // 2.5 % each: more than 4 with a probability below 0.02 %
}

TEST(NonFinite, AnAssertionOnARegionWithSuchPixelsFails) {
    MemoryRenders m = arms(4);
    set_pixel(m, 'b', 35, 4);  // (3, 2)
    const auto state = [&](const char* region, const std::string& arm) {
        const CompareFlag box{{"regions", "part", "box"}, region, true, ""},
            check{{"assertions", "it", "check"}, "y_mean.part(" + arm + ") < 9", false, ""};
        return m.compare({box, check}).state;
    };
    EXPECT_EQ(state("[0, 0, 7, 7]", "b"), State::fails);
    EXPECT_EQ(state("[0, 0, 7, 7]", "a"), State::fails);
    EXPECT_EQ(state("[8, 8, 15, 15]", "b"), State::holds);
    EXPECT_EQ(state("[3, 2, 3, 2]", "b"), State::fails);  // none of its pixels is finite
}

TEST(NonFinite, AnAssertionOnASingleArmWithSuchPixelsFails) {
    MemoryRenders m;
    for (std::uint32_t k = 0; k < 3; ++k) m.put("a" + std::to_string(k), k);
    const CompareFlag check{{"assertions", "it", "check"}, "y_mean.frame(a) < 9", false, ""};
    EXPECT_EQ(m.compare({check}).state, State::holds);
    set_pixel(m, 'a', 35, 3);
    EXPECT_EQ(m.compare({check}).state, State::fails);
}

TEST(NonFinite, ASideWithoutAnyFinitePixelDiffers) {
    MemoryRenders m = arms(2);
    for (std::size_t i = 0; i < 256; ++i) set_pixel(m, 'b', i, 2);
    const CompareResult r = m.compare({same, wide});
    EXPECT_EQ(r.state, State::fails);
    EXPECT_EQ(r.bias[0].non_finite.a.pixels.size(), 256u);
    EXPECT_EQ(r.arms[0].region(whole_frame).pixels, 0u);
    EXPECT_FALSE(r.arms[0].region(whole_frame).metric("y_mean").value);
}

TEST(NonFinite, ANonFiniteStatisticIsInconclusive) {
    MemoryRenders m = arms(4);
    Render& reference = m.put("reference", 1);
    reference.variance.assign(reference.size(), INFINITY);
    reference.variance_channels = "variance.Y";
    const CompareResult r =
        m.compare({same, wide, {{"reference"}, "reference", false, ""}, {{"flip"}, "false", true, ""}});
    EXPECT_EQ(r.state, State::inconclusive) << r.sentence;
    EXPECT_FALSE(r.bias[0].regions[0].why.empty());
}

// Red is 5 % brighter and blue 15 % darker, so that Y is the same.
TEST(Channels, AHueAtEqualLuminanceIsFoundAndNamed) {
    SyntheticScene w{{Kind::gamma, 0.2}, {Kind::gamma, 0.2}, 8, 32, false, 0.25};
    w.b.hue = 0.05;
    const CompareResult r = compare_synthetic(w, 3, {same, wide});
    EXPECT_EQ(r.state, State::fails);
    const MeanTest& frame = r.bias[0].regions[0];
    EXPECT_THAT(frame.differs_in(), ElementsAre("R", "B"));
    ASSERT_EQ(frame.channels.size(), 3u);
    EXPECT_NEAR(frame.channels[0].a / frame.channels[0].b, 1.05, 0.005);
    EXPECT_NEAR(frame.channels[2].a / frame.channels[2].b, 1 - 0.05 * 0.2126 / 0.0722, 0.005);
    EXPECT_THAT(r.sentence, HasSubstr("mean R in frame"));
    EXPECT_THAT(r.sentence, HasSubstr("mean B in frame"));
    EXPECT_EQ(r.bias[0].tiles.different, 16u);
    EXPECT_EQ(r.bias[0].tiles_by[3], 16u);  // blue has the smallest p
    EXPECT_EQ(r.bias[0].shown(), 3u);
}

TEST(Channels, ADifferenceInOneChannelIsFound) {
    for (const std::size_t channel : {0, 1, 2}) {
        MemoryRenders m = arms(8, 32);
        for (auto& [name, r] : m.renders) {
            std::vector<float>& plane = channel == 0 ? r.r : channel == 1 ? r.g : r.b;
            for (std::size_t i = 0; i < 8 * 32; ++i)
                if (name[0] == 'b') plane[i] *= 1.1f;  // one row of tiles
        }
        const CompareResult r = m.compare({same, wide});
        EXPECT_EQ(r.state, State::fails);
        EXPECT_GE(r.bias[0].tiles.different, 4u);
        EXPECT_EQ(r.bias[0].tiles_by[channel + 1] + r.bias[0].tiles_by[0], r.bias[0].tiles.different);
    }
}

TEST(Channels, GreyRendersAreTestedOnce) {
    const CompareResult r = compare_synthetic({{Kind::gamma, 0.2}, {Kind::gamma, 0.2}, 4, 24, false}, 3);
    EXPECT_TRUE(r.bias[0].regions[0].channels.empty());
    EXPECT_EQ(r.bias[0].regions[0].joint_p, r.bias[0].regions[0].welch.p);
    EXPECT_EQ(r.bias[0].tiles_by.size(), 1u);
}

// alpha = 0.05: 2 of 40 on average, more than 7 with a probability of 0.4 %.
TEST(Channels, EqualArmsInColourRarelyDiffer) {
    for (const SyntheticNoise& noise : {SyntheticNoise{Kind::gamma, 0.2}, {Kind::lognormal, 1}}) {
        int alarms = 0;
        for (std::uint32_t seed = 1; seed <= 40; ++seed)
            alarms += compare_synthetic({noise, noise, 4, 24, false, 0.25}, seed).differs();
        EXPECT_LE(alarms, 7);
    }
}

TEST(SharedSeeds, AreRecognisedInAnyOrderAndComparedInPairs) {
    for (const int renders : {3, 4, 8}) {
        SyntheticScene w{{Kind::gamma, 0.2}, {Kind::gamma, 0.2, 0.002}, renders, 32, false, 0.25, renders};
        const BiasResult with = compare_synthetic(w, 5).bias[0];
        EXPECT_TRUE(with.all_shared);
        EXPECT_TRUE(with.paired);
        EXPECT_TRUE(with.differs()) << with.sentence;
        ASSERT_EQ(with.shared.size(), static_cast<std::size_t>(renders));
        for (const SeedPair& p : with.shared) {
            EXPECT_EQ(p.a + p.b, static_cast<std::size_t>(renders - 1));
            EXPECT_GT(p.correlation, 0.99);
        }
        w.shared = 0;
        const BiasResult without = compare_synthetic(w, 5).bias[0];
        EXPECT_TRUE(without.shared.empty());
        EXPECT_FALSE(without.paired);
        EXPECT_FALSE(without.differs()) << without.sentence;
    }
}

TEST(SharedSeeds, OfSomeRendersPairOnlyThese) {
    for (const int shared : {2, 4}) {
        const SyntheticScene w{{Kind::gamma, 0.2}, {Kind::gamma, 0.2, 0.002}, 6, 32, false, 0, shared};
        const BiasResult found = compare_synthetic(w, 5).bias[0];
        EXPECT_EQ(found.shared.size(), static_cast<std::size_t>(shared));
        for (const SeedPair& p : found.shared) EXPECT_GT(p.correlation, 0.999);
        EXPECT_FALSE(found.all_shared);
        EXPECT_EQ(found.paired, shared == 4) << found.sentence;  // two pairs have one degree of freedom
        EXPECT_EQ(found.differs(), shared == 4) << found.sentence;
    }
}

TEST(SharedSeeds, AreNotFoundInIndependentRenders) {
    for (const SyntheticNoise& noise : {SyntheticNoise{Kind::gamma, 0.2}, {Kind::lognormal, 1}, {Kind::pareto, 1.5}})
        for (std::uint32_t seed = 1; seed <= 40; ++seed)  // 1e-3 each
            EXPECT_TRUE(compare_synthetic({noise, noise, 6, 24, false}, seed).bias[0].shared.empty()) << seed;
}

// The same renders with sums in another order: relative differences of 1e-6, all of one sign.
TEST(SharedSeeds, SumsInAnotherOrderAreNotADifference) {
    for (const auto& [factor, differs] : {std::pair(1 + 1e-6f, false), {1 + 1e-4f, true}}) {
        MemoryRenders m;
        for (std::uint32_t k = 0; k < 8; ++k) {
            m.put("a" + std::to_string(k), k, 32);
            Render& b = m.put("b" + std::to_string(k), k, 32);
            for (auto* plane : {&b.r, &b.g, &b.b})
                for (float& x : *plane) x *= factor;
        }
        const CompareResult r = m.compare({same});
        EXPECT_TRUE(r.bias[0].paired);
        EXPECT_EQ(r.bias[0].differs(), differs) << r.bias[0].sentence;
    }
}

// The differences are 0 except in one pixel, which decides their mean.
TEST(SharedSeeds, IfAFewPixelsDecideRendersAreTestedAsIndependent) {
    MemoryRenders m;
    for (std::uint32_t k = 0; k < 8; ++k) {
        m.put("a" + std::to_string(k), k, 32);
        m.put("b" + std::to_string(k), k, 32);
        m.renders["b" + std::to_string(k)].g[7] += k == 3 ? 5.0f : 1e-3f;
    }
    const CompareResult r = m.compare({same, wide, loose});
    EXPECT_TRUE(r.bias[0].paired);
    EXPECT_FALSE(r.bias[0].regions[0].paired);
    EXPECT_EQ(r.state, State::holds) << r.sentence;
}

TEST(Identical, FilesAreTheSame) {
    for (const int renders : {1, 4}) {
        MemoryRenders m;
        for (int k = 0; k < renders; ++k) {
            m.put("a" + std::to_string(k), static_cast<std::uint32_t>(k));
            m.put("b" + std::to_string(9 - k), static_cast<std::uint32_t>(k));
        }
        const CompareResult r = m.compare({same});
        EXPECT_EQ(r.state, State::holds) << r.sentence;
        EXPECT_TRUE(r.bias[0].identical);
        EXPECT_FALSE(r.bias[0].differs());
        m.renders.begin()->second.r[3] += 0.5f;
        EXPECT_FALSE(m.compare({same}).bias[0].identical);
    }
}

TEST(Identical, OneFilePerSideIsDescribedAndInconclusive) {
    MemoryRenders m;
    m.put("a", 1);
    m.put("b", 1).b[37] += 0.25f;
    const CompareResult r = m.compare({same});
    EXPECT_EQ(r.state, State::inconclusive);
    ASSERT_TRUE(r.bias[0].single);
    EXPECT_EQ(r.bias[0].single->different, 1u);
    EXPECT_NEAR(r.bias[0].single->largest, 0.25, 1e-6);
    EXPECT_EQ(r.bias[0].single->place.x0, 5);
    EXPECT_EQ(r.bias[0].single->place.y0, 2);
}

}  // namespace bias_test
}  // namespace crescent
