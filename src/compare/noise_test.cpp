// Pairs of renders, the noise of tiles, rankings, ladders and spectra, each with a known result.
#include "compare/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "compare/compare.h"
#include "compare/shared_seeds.h"
#include "tests/support/synthetic_renders.h"

namespace crescent {
namespace noise_test {

using Pairs = std::vector<RenderPair>;

/// An arm whose files have these numbers in their names.
ArmStats numbered(const std::vector<std::vector<std::uint64_t>>& numbers) {
    ArmStats out;
    for (const auto& n : numbers) out.files.emplace_back().numbers = n;
    return out;
}

TEST(PairsByName, HaveTheNumberThatVariesWithinAnArm) {
    const ArmStats a = numbered({{16, 1}, {16, 2}, {16, 3}}), b = numbered({{64, 3}, {64, 1}, {64, 2}});
    EXPECT_EQ(pairs_of(a, b), (Pairs{{0, 1}, {1, 2}, {2, 0}}));
    EXPECT_EQ(pairs_of(numbered({{7}}), numbered({{7}})), (Pairs{{0, 0}}));
}

TEST(PairsByName, ARenderWithoutOnePartnerIsRefused) {
    EXPECT_THROW((void)pairs_of(numbered({{1}, {2}}), numbered({{1}, {3}})), InputError);
    EXPECT_THROW((void)pairs_of(numbered({{1}, {2}}), numbered({{1}, {2}, {3}})), InputError);
    EXPECT_THROW((void)pairs_of(numbered({{1}, {2}}), numbered({{1}, {1}, {2}})), InputError);
    EXPECT_THROW((void)pairs_of(numbered({{}}), numbered({{}})), InputError);
}

/// `count` pairs of equal correlation.
std::vector<SeedPair> seed_pairs(std::size_t count, double correlation) {
    std::vector<SeedPair> out;
    for (std::size_t k = 0; k < count; ++k) out.push_back({k, k, correlation});
    return out;
}

// 8 pairs at level 1 %: (1 - r) t(7)^2 < t(14)^2, with the quantiles 3.4995 and 2.9768, from r = 0.2764 on.
TEST(SharedSeedPairs, AreTestedIfThatIsSharper) {
    ArmStats arm;
    arm.files.resize(8);
    EXPECT_TRUE(sharper_in_pairs(seed_pairs(8, 0.28), arm, arm, 0.01));
    EXPECT_FALSE(sharper_in_pairs(seed_pairs(8, 0.27), arm, arm, 0.01));
    EXPECT_FALSE(sharper_in_pairs(seed_pairs(2, 1), arm, arm, 0.01));
    EXPECT_TRUE(all_paired(seed_pairs(8, 1), arm, arm));
    EXPECT_FALSE(all_paired(seed_pairs(7, 1), arm, arm));
    EXPECT_FALSE(all_paired({}, {}, {}));
}

TEST(SeedSamples, AreSpreadOverSixteenBlocks) {
    RenderStats all;
    all.width = all.height = 128;
    all.bad.assign(128 * 128, false);
    const SeedSamples at = seed_samples(all);  // 512 of the 1024 pixels of a block: every second
    ASSERT_EQ(at.ends.size(), 16u);
    for (std::size_t k = 0; k < 16; ++k) EXPECT_EQ(at.ends[k], 512 * (k + 1));
    EXPECT_EQ(at.pixels[1], 2u);
    EXPECT_EQ(at.pixels[512], 32u);
    all.bad[2] = true;
    EXPECT_EQ(seed_samples(all).ends[0], 511u);
}

TEST(SeedSamples, ResidualsAreInStandardDeviations) {
    MeanFilm film;
    film.count = 3;
    film.planes = {{{1, 1, 1}, {8, 8, 0}}};  // variance 4, 4, 0
    EXPECT_EQ(residuals({5, -1, 9}, film, {{0, 1, 2}, {3}}), (std::vector<float>{2, -1, 0}));
}

/// Four renders with these spreads in three tiles, about 1 % apart.
ArmStats spreads(const std::vector<double>& of_tiles) {
    ArmStats out;
    out.files.resize(4);
    QuantityReadings& readings = out.quantities.emplace_back();
    for (const double factor : {0.99, 1.0, 1.01, 1.005}) {
        readings.tiles.emplace_back();
        for (const double s : of_tiles) readings.tiles.back().push_back({1, factor * s, 0});
    }
    return out;
}

TEST(NoiseOfTiles, IsComparedByTheRatioOfVariances) {
    ComparePlan plan;
    plan.arms.resize(2);
    RenderStats all;
    all.width = 24;
    all.height = 8;
    all.tiles = Tiles(24, 8);
    all.arms = {spreads({4, 1, 1}), spreads({1, 1, 0})};
    PixelSet& frame = all.regions.emplace_back();
    frame.pixels.resize(24 * 8);
    std::iota(frame.pixels.begin(), frame.pixels.end(), 0u);
    const NoiseResult noise = compare_noise(plan, all, 0, 1, 0.01);
    ASSERT_EQ(noise.log2_ratio.size(), 3u);
    EXPECT_NEAR(noise.log2_ratio[0], 2, 1e-12);
    EXPECT_NEAR(noise.log2_ratio[1], 0, 1e-12);
    EXPECT_TRUE(std::isnan(noise.log2_ratio[2]));
    EXPECT_EQ(noise.distinguished, (std::vector<bool>{true, false, false}));
    EXPECT_EQ(noise.regions[0].different[12], 1u);  // bins of 0.5 from -4 on
    EXPECT_EQ(noise.regions[0].undistinguished[8], 1u);
}

/// An arm with one metric in one region, and an interval of this factor around it.
ArmResult measured(const std::string& name, const char* metric, double value, double factor, double spp = 1) {
    ArmResult out;
    out.name = name;
    out.spp = spp;
    out.regions.emplace_back().metrics = {{metric, {value, {{value / factor, value * factor}}, ""}}};
    return out;
}

TEST(Rankings, OrderArmsByTheFirstMetricThatAllHave) {
    CompareResult result;
    result.arms = {measured("a", "unit_time", 2, 1.1), measured("b", "unit_time", 1, 1.1)};
    for (ArmResult& arm : result.arms) arm.regions[0].metrics.emplace_back("var", MetricValue{3, {}, ""});
    result.arms[1].regions[0].metrics[1].second.value = 4;
    const std::vector<Ranking> found = rank(result);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].order, (std::vector<std::string>{"b", "a"}));
    EXPECT_EQ(found[1].order, (std::vector<std::string>{"a", "b"}));  // render by render: no samples are stated
    result.arms[0].regions[0].metrics[0].second.value.reset();
    EXPECT_EQ(rank(result).size(), 1u);
    result.arms.pop_back();
    EXPECT_TRUE(rank(result).empty());
}

TEST(SppLadders, HaveTheSlopeOfTheirLogarithms) {
    CompareResult result;
    for (const auto& [spp, rmse] : {std::pair(64, 0.2), {16, 0.4}, {256, 0.1}})
        result.arms.push_back(measured("path-" + std::to_string(spp), "rmse", rmse, std::exp(0.3), spp));
    result.arms.push_back(measured("p116", "rmse", 1, 2, 16));  // its number goes on before the 16
    result.arms.push_back(measured("bdpt-16", "rmse", 1, 2, 16));
    const std::vector<SppLadder> ladders = ladders_of(result);
    ASSERT_EQ(ladders.size(), 1u);
    EXPECT_EQ(ladders[0].name, "path");
    EXPECT_EQ(ladders[0].arms, (std::vector<std::size_t>{1, 0, 2}));
    const MetricValue& slope = ladders[0].slopes[0].second;
    EXPECT_NEAR(*slope.value, -0.5, 1e-12);
    EXPECT_NEAR(slope.interval->second - *slope.value, 0.3 * std::sqrt(2.0) / (2 * std::log(4)), 1e-12);
}

TEST(SppLadders, WithoutAReferenceAreOfTheStandardDeviation) {
    CompareResult result;
    for (const auto& [spp, var] : {std::pair(16, 4.0), {64, 1.0}})
        result.arms.push_back(measured("path" + std::to_string(spp), "var", var, 1.21, spp));
    EXPECT_NEAR(*ladders_of(result).at(0).slopes[0].second.value, -0.5, 1e-12);
    const RegionResult& region = result.arms[0].regions[0];
    const MetricValue deviation = ladder_metric(region.metric("rmse"), region.metric("var"));
    EXPECT_DOUBLE_EQ(*deviation.value, 2);
    EXPECT_DOUBLE_EQ(deviation.interval->second, 2.2);
}

TEST(Spectrum, DistinguishesFilteredFromWhiteNoise) {
    std::vector<double> white, filtered;
    const auto noise = [](int x, int y) {
        return synthetic_pixel({SyntheticNoise::Kind::normal, 1, 0}, 9, static_cast<std::uint32_t>(y * 65 + x), 65) - 1;
    };
    const Box box{0, 0, 63, 63};
    add_spectrum(white, box, noise);
    add_spectrum(filtered, box,
        [&](int x, int y) { return noise(x, y) + noise(x + 1, y) + noise(x, y + 1) + noise(x + 1, y + 1); });
    EXPECT_EQ(noise_colour(white), NoiseColour::white);
    EXPECT_EQ(noise_colour(filtered), NoiseColour::correlated);
}

// A cosine of 5 cycles: |F|^2 = 512^2 at +5 and -5, over 32^2 pixels and the coefficients of its ring.
TEST(Spectrum, ContainsThePowerOfAWave) {
    double ring = 0;
    for (int v = -15; v <= 16; ++v)
        for (int u = -15; u <= 16; ++u) ring += std::lround(std::hypot(u, v)) == 5;
    const auto wave = [](int x, int) { return x < 32 ? std::cos(2 * 3.141592653589793 * 5 * x / 32) : 7.0; };
    std::vector<double> power;
    add_spectrum(power, {0, 0, 31, 31}, wave);
    for (std::size_t k = 0; k < power.size(); ++k) EXPECT_NEAR(power[k], k == 4 ? 512 / ring : 0, 1e-9) << k;
    std::vector<double> first, none;
    add_spectrum(first, {0, 0, 127, 31}, wave, 1);
    EXPECT_EQ(first, power);
    add_spectrum(none, {0, 0, 30, 31}, wave);
    EXPECT_TRUE(none.empty());
}

TEST(Spectrum, BlueNoiseHasItsPowerAtHighFrequencies) {
    std::vector<double> power(spectrum_bins, 1);
    EXPECT_EQ(noise_colour(power), NoiseColour::white);
    for (std::size_t k = spectrum_bins / 2; k < power.size(); ++k) power[k] = 1.3;
    EXPECT_EQ(noise_colour(power), NoiseColour::blue);
    EXPECT_EQ(noise_colour(std::vector<double>(spectrum_bins)), NoiseColour::unknown);
}

}  // namespace noise_test
}  // namespace crescent
