// Counts and tests of compare, on synthetic renders with known truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compare/plan.h"
#include "compare/results.h"
#include "tests/support/synthetic_renders.h"

namespace crescent {
namespace bias_and_noise_test {

using ::testing::HasSubstr;
using Kind = SyntheticNoise::Kind;
using State = CompareResult::State;

constexpr SyntheticNoise coarse{Kind::normal, 0.5, 0}, fine{Kind::normal, 0.2, 0};

SyntheticScene world(int renders, double bias, int width = 24) {
    return {coarse, {Kind::normal, 0.2, bias}, renders, width};
}

BiasResult between(const CompareResult& r, const std::string& a, const std::string& b) {
    return *std::find_if(r.bias.begin(), r.bias.end(), [&](const BiasResult& x) { return x.a == a && x.b == b; });
}

int alarms(const SyntheticScene& world, int repeats) {
    int out = 0;
    for (int seed = 1; seed <= repeats; ++seed)
        out += compare_synthetic(world, static_cast<std::uint32_t>(seed)).differs();
    return out;
}

// alpha = 0.05 per call: 3 of 60 on average, more than 9 with a probability below 0.2 %.
TEST(CompareJudges, EqualArmsAreRarelyToldApart) { EXPECT_LE(alarms(world(4, 0), 60), 9); }

TEST(CompareJudges, RareBrightEventsAreRarelyTakenForABias) {
    for (const double chance : {0.01, 1e-3}) {
        SCOPED_TRACE(chance);
        EXPECT_LE(alarms({{Kind::events, chance, 0}, fine, 6, 24}, 40), 7);  // more: 0.4 %
    }
    EXPECT_LE(alarms({{Kind::lognormal, 1, 0}, fine, 6, 24}, 40), 7);
}

// Two versions of a renderer have the same noise: events that no render met are missing on both sides.
TEST(CompareJudges, EqualRareEventsAreRarelyDistinguished) {
    for (const SyntheticNoise& noise :
        {SyntheticNoise{Kind::events, 1e-3}, {Kind::events, 1e-4}, {Kind::pareto, 1.5}, {Kind::sparks, 2e-3}}) {
        SCOPED_TRACE(to_string(noise));
        EXPECT_LE(alarms({noise, noise, 6, 24, false}, 40), 7);
    }
}

// Renders that met none of an arm's events look like those of a darker arm. This is reported with the difference; if a
// bound on the pixel value allows for such events, no difference is reported.
TEST(CompareJudges, UnseenEventsAreReportedAndBounded) {
    const SyntheticScene w{{Kind::events, 1e-4, 0}, fine, 4, 24};
    const CompareFlag same{{"expect"}, "same", false, ""}, bound{{"brightest"}, "10000", true, ""};
    int missed = 0;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        if (have_events(w, seed)) continue;
        ++missed;
        const CompareResult without = compare_synthetic(w, seed, {same}),
                            with = compare_synthetic(w, seed, {same, bound});
        EXPECT_EQ(without.state, State::fails);
        const BiasResult describe = between(without, "a", the_reference), allowed = between(with, "a", the_reference);
        EXPECT_THAT(describe.sentence, HasSubstr("If there is no bias, a has events brighter than"));
        ASSERT_TRUE(describe.missed_events);
        EXPECT_LT(describe.missed_events->size, event_size(w.a));
        EXPECT_FALSE(allowed.differs()) << allowed.sentence;
        EXPECT_THAT(allowed.sentence, HasSubstr("heavy tail: a is darker by "));
        EXPECT_EQ(with.state, State::inconclusive) << with.sentence;
    }
    EXPECT_GE(missed, 3);
}

TEST(CompareJudges, AlarmsAreRareWhereTheRareEventsWereMet) {
    int alarms = 0, calls = 0;
    for (std::uint32_t seed = 1; calls < 40; ++seed) {
        const SyntheticScene w{{Kind::events, 1e-4, 0}, fine, 8, 24};
        if (!have_events(w, seed)) continue;
        ++calls;
        alarms += compare_synthetic(w, seed).differs();
    }
    EXPECT_LE(alarms, 7);
}

TEST(CompareJudges, ABiasOfFivePercentIsFound) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        const BiasResult found = between(compare_synthetic(world(6, 0.05), seed), "b", the_reference);
        EXPECT_TRUE(found.differs()) << found.sentence;
        EXPECT_THAT(found.sentence, HasSubstr("differs from the reference"));
    }
}

TEST(CompareJudges, TilesAndPixelsThatDifferAreNamed) {
    SyntheticScene w{{Kind::normal, 0.01, 0}, {Kind::normal, 0.01, 0.5}, 8, 24};
    const BiasResult found = between(compare_synthetic(w, 1), "b", "a");
    EXPECT_EQ(found.tiles.different, 9u);
    EXPECT_EQ(found.pixels_different, 24u * 24u);
    EXPECT_EQ(found.tiles_found.size(), 5u);
    EXPECT_NEAR(found.tiles_found[0].a / found.tiles_found[0].b, 1.5, 0.01);
    EXPECT_THAT(found.sentence, HasSubstr("9 of 9 tiles differ: x "));
    EXPECT_THAT(found.sentence, HasSubstr("576 of 576 pixels differ: ("));
}

TEST(CompareJudges, PIsSpreadEvenlyOverPixelsOfEqualArms) {
    const BiasResult found = between(compare_synthetic({fine, fine, 8, 64}, 3), "b", "a");
    ASSERT_EQ(found.pixel_p.size(), 20u);
    EXPECT_EQ(found.pixels_tested, 4096u);
    // 205 per bin on average, standard deviation 14; Welch's test is slightly conservative at few degrees of freedom.
    for (const std::uint64_t count : found.pixel_p) EXPECT_NEAR(static_cast<double>(count), 204.8, 5 * 14.0);
}

TEST(CompareJudges, IntervalsHoldTheTruthAsOftenAsTheySay) {
    constexpr int repeats = 100;
    std::map<std::string, int> held;
    const std::map<std::string, double> truth{{"var", 0.04}, {"bias2", 0.01}, {"rmse", std::sqrt(0.05)},
        {"relmse", 0.05 / 1.01}, {"y_mean", 1.1}, {"efficiency", 12.5}, {"unit_time", 0.08}, {"sample_var", 0.64}};
    const SyntheticScene w{coarse, {Kind::normal, 0.2 / 1.1, 0.1}, 6, 24};
    for (std::uint32_t seed = 1; seed <= repeats; ++seed) {
        const CompareResult r = compare_synthetic(
            w, seed + 200, {{{"arms", "b", "seconds"}, "2", true, ""}, {{"arms", "b", "spp"}, "16", true, ""}});
        for (const auto& [metric, value] : truth) {
            const MetricValue& m = r.arms[1].region(whole_frame).metric(metric);
            held[metric] += m.interval && m.interval->first <= value && value <= m.interval->second;
        }
    }
    // 95 of 100 are expected; fewer than 86 with a probability below 0.1 %.
    for (const auto& [metric, count] : held) EXPECT_GE(count, 86) << metric;
}

TEST(CompareJudges, MetersAreWhatTheirNamesSay) {
    const SyntheticScene w{coarse, {Kind::normal, 0.2 / 1.1, 0.1}, 8, 24};
    const CompareResult r =
        compare_synthetic(w, 7, {{{"arms", "b", "seconds"}, "2", true, ""}, {{"flip"}, "true", true, ""}});
    const RegionResult& b = r.arms[1].region(whole_frame);
    EXPECT_NEAR(*b.metric("var").value, 0.04, 0.002);
    EXPECT_NEAR(*b.metric("bias2").value, 0.01, 0.001);
    EXPECT_NEAR(*b.metric("rmse").value, std::sqrt(0.05), 0.005);
    EXPECT_NEAR(*b.metric("relmse").value, 0.05 / 1.01, 0.002);
    EXPECT_NEAR(*b.metric("y_mean").value, 1.1, 0.01);
    EXPECT_NEAR(*b.metric("efficiency").value, 1 / (2 * *b.metric("var").value), 1e-9);
    EXPECT_NEAR(*b.metric("unit_time").value, 2 * *b.metric("var").value, 1e-12);
    EXPECT_GT(*b.metric("flip_ldr").value, 0);
    EXPECT_FALSE(r.arms[0].region(whole_frame).metric("efficiency").value);
    EXPECT_FALSE(b.heavy());
}

TEST(CompareJudges, AHeavyTailHasNoIntervalOfSquares) {
    int heavy = 0, numbered = 0;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        const CompareResult events = compare_synthetic({{Kind::events, 1e-3, 0}, fine, 6, 32}, seed),
                            skewed = compare_synthetic({{Kind::lognormal, 1, 0}, fine, 6, 32}, seed);
        for (const CompareResult* r : {&events, &skewed}) {
            const RegionResult& a = r->arms[0].region(whole_frame);
            if (!a.heavy()) continue;
            ++heavy;
            numbered += a.renders_needed.has_value();
            if (a.renders_needed) EXPECT_GE(*a.renders_needed, 6);
            EXPECT_FALSE(a.metric("rmse").interval);
            ASSERT_TRUE(a.metric("fireflies").interval);
            EXPECT_GE(a.metric("fireflies").interval->first, 0);
            EXPECT_LE(a.metric("fireflies").interval->second, static_cast<double>(a.pixels));
        }
    }
    EXPECT_GE(heavy, 15);
    EXPECT_GE(numbered, 5);  // where the mean of squares has one, the number of renders from which an interval is given
}

TEST(CompareJudges, SameRequiresEnoughPower) {
    const std::vector<CompareFlag> same{{{"expect"}, "same", false, ""}};
    EXPECT_EQ(compare_synthetic(world(3, 0), 3, same).state, State::inconclusive);
    std::vector<CompareFlag> large = same;
    large.push_back({{"smallest"}, "0.5", true, ""});
    EXPECT_EQ(compare_synthetic(world(8, 0), 3, large).state, State::holds);
    EXPECT_EQ(compare_synthetic(world(8, 0.3), 3, large).state, State::fails);
}

TEST(CompareJudges, ArmsAreRankedOnlyWhereTheirIntervalsPart) {
    const std::vector<CompareFlag> seconds{
        {{"arms", "a", "seconds"}, "1", true, ""}, {{"arms", "b", "seconds"}, "1", true, ""}};
    const auto by_time = [&](const SyntheticScene& w) {
        const CompareResult r = compare_synthetic(w, 5, seconds);
        return std::find_if(r.rankings.begin(), r.rankings.end(), [](const Ranking& x) {
            return x.measure == "at equal time";
        })->sentence;
    };
    EXPECT_THAT(by_time(world(6, 0)), HasSubstr("b before a"));
    EXPECT_THAT(by_time({fine, fine, 6, 24}), HasSubstr("no difference between"));
}

TEST(CompareJudges, NoiseMovedWhereTheVariancesAreToldApart) {
    const CompareResult r = compare_synthetic(world(8, 0), 5);
    ASSERT_EQ(r.noise.size(), 1u);
    const NoiseResult& n = r.noise[0];  // b over a: 0.04 / 0.25
    EXPECT_EQ(std::count(n.distinguished.begin(), n.distinguished.end(), true), 9);
    for (const double x : n.log2_ratio) EXPECT_NEAR(x, std::log2(0.16), 0.7);
    std::uint64_t tiles = 0;
    for (const std::uint64_t count : n.regions.back().different) tiles += count;
    EXPECT_EQ(tiles, 9u);
    const CompareResult equal = compare_synthetic({fine, fine, 8, 24}, 5);
    EXPECT_EQ(std::count(equal.noise[0].distinguished.begin(), equal.noise[0].distinguished.end(), true), 0);
}

}  // namespace bias_and_noise_test
}  // namespace crescent
