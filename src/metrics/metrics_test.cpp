// Films of a few pixels whose metrics are computed by hand, and tails with a known index.
#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>

#include "math/simd/random.h"
#include "math/statistics.h"
#include "metrics/metrics.h"
#include "render/estimator.h"
#include "render/reference/reference.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace metrics_test {

/// Returns the tail of n Pareto samples u^-k.
std::optional<Tail> pareto_tail(double k, std::uint32_t seed, std::uint64_t n = 20000) {
    std::vector<double> x;
    for (std::uint64_t j = 0; j < n; ++j) x.push_back(std::pow(static_cast<double>(draw(seed, 0, j).x), -k));
    std::sort(x.begin(), x.end(), std::greater<>());
    x.resize(tail_length(n) + 1);
    return fit_tail(std::span<const double>(x));
}

TEST(TailIndex, RecoversTheExponentOfAPareto) {
    for (double k : {0.2, 0.5, 0.778, 0.939}) {
        int outside = 0;
        for (std::uint32_t seed = 0; seed < 40; ++seed) {
            const Tail tail = *pareto_tail(k, seed);
            outside += std::fabs(tail.k - k) > 2 * tail.se;
        }
        EXPECT_LE(outside, 8) << k;  // about 2 of 40 are expected
    }
}

TEST(TailIndex, BoundedIsLightAndConstantHasNoTail) {
    std::vector<float> x;
    for (std::uint64_t j = 0; j < 20000; ++j) x.push_back(draw(1, 0, j).x);
    std::sort(x.begin(), x.end(), std::greater<>());
    x.resize(tail_length(20000) + 1);
    EXPECT_LT(fit_tail(std::span<const float>(x))->k, 0);
    EXPECT_FALSE(fit_tail(std::span<const float>(x))->heavy());
    EXPECT_FALSE(fit_tail(std::span<const float>(std::vector<float>(100, 3.0f))).has_value());
    EXPECT_FALSE(fit_tail(std::span<const float>(std::vector<float>(3, 3.0f))).has_value());
}

TEST(TailIndex, PooledFitIgnoresTheStepToLitSamples) {
    std::vector<float> mixed, heavy;
    for (std::uint64_t j = 0; j < 500'000; ++j) {
        const Vec2<float> u = draw(2, 0, j);
        mixed.push_back(u.x < 0.003f ? 90 + 10 * u.y : u.y);  // bounded: four in a thousand meet a light
        heavy.push_back(std::pow(u.x, -0.9f));
    }
    for (auto* x : {&mixed, &heavy}) {
        std::sort(x->begin(), x->end(), std::greater<>());
        x->resize(tail_length(500'000) + 1);
    }
    EXPECT_TRUE(fit_tail(std::span<const float>(mixed))->heavy());  // the fit at the usual threshold
    EXPECT_FALSE(fit_pooled_tail(mixed)->heavy());
    EXPECT_TRUE(fit_pooled_tail(heavy)->heavy());
}

/// Samples of a scene of plain materials: a few of many meet a light by the gloss of one object or another.
TEST(TailIndex, PooledFitSeesNoTailInGroups) {
    std::vector<float> groups, equal, heavy;
    for (std::uint64_t j = 0; j < 4'000'000; ++j) {
        const Vec2<float> u = draw(3, 0, j);
        groups.push_back(u.x < 1.5e-5f ? 8.75f + 0.02f * u.y : u.x < 1.8e-4f ? 5.4f + 0.02f * u.y : 0.1757f * u.y);
        equal.push_back(u.x < 3e-4f ? 8.8f : u.x < 2e-3f ? 0.5f + 1e-4f * u.y : 0.2f * u.y);
        heavy.push_back(u.x < 1e-4f ? 8.75f * std::pow(u.y, -0.7f) : 0.1757f * u.y);
    }
    for (auto* x : {&groups, &equal, &heavy}) {
        std::sort(x->begin(), x->end(), std::greater<>());
        x->resize(tail_length(4'000'000) + 1);
    }
    EXPECT_FALSE(fit_pooled_tail(groups)->heavy());
    EXPECT_FALSE(fit_pooled_tail(equal).has_value());
    EXPECT_TRUE(fit_pooled_tail(heavy)->heavy());
    EXPECT_NEAR(fit_pooled_tail(heavy)->k, 0.7, 0.3);  // of the tail, not of the step to it
}

TEST(TailIndex, TakesTheTailLengthOfParetoSmoothing) {
    EXPECT_EQ(tail_length(10), 0u);
    EXPECT_EQ(tail_length(100), 20u);
    EXPECT_EQ(tail_length(10000), 300u);
}

/// Two estimates of 8 pixels around 1, and a film: what is known of its squared error.
TEST(PairedMetrics, AreThoseOfTheProductOfTwoErrors) {
    Experiment experiment;
    experiment.regions = {{"all", {0, 0, 3, 1}, {}}};
    experiment.reference.kind = ReferenceKind::paired;
    const ShapeMap shapes{4, 2, std::vector<std::int16_t>(8)};
    Film film(4, 2, 10);
    ReferenceFilm reference(4, 2, 32);
    double products = 0, own = 0, variance = 0;
    for (std::size_t k = 0; k < 8; ++k) {
        const double first = 1 + 0.125 * double(k % 3), second = 1 - 0.25 * double(k % 2), y = 1 + 0.5 * double(k % 4);
        film.y[k] = static_cast<float>(y);
        reference.y[k] = static_cast<float>(0.5 * (first + second));
        reference.error[k] = static_cast<float>(0.5 * std::fabs(first - second));
        products += (y - first) * (y - second);
        own += sqr(0.5 * (first - second));
        variance += sqr(y - 0.5 * (first + second)) * sqr(first - second);
    }
    const RegionMetrics far = measure(experiment, {"a", 10, 32, 1}, film, reference, shapes).regions[0];
    EXPECT_TRUE(far.is_paired());
    EXPECT_NEAR(far.mse, products / 8, 1e-7);
    EXPECT_NEAR(far.rmse, std::sqrt(products / 8), 1e-7);
    EXPECT_NEAR(far.reference_error, std::sqrt(own / 8), 1e-7);
    EXPECT_NEAR(far.mse_error, std::sqrt(variance) / 8, 1e-7);
    film.y = reference.y;  // as near as the reference's own mean: the estimate of its squared error is negative
    const RegionMetrics near = measure(experiment, {"a", 10, 32, 1}, film, reference, shapes).regions[0];
    EXPECT_NEAR(near.mse, -own / 8, 1e-7);
    EXPECT_TRUE(std::isnan(near.rmse));
    EXPECT_TRUE(std::isinf(share_of_reference(near)));
    experiment.reference.kind = ReferenceKind::quadrature;
    EXPECT_FALSE(measure(experiment, {"a", 10, 32, 1}, film, reference, shapes).regions[0].is_paired());
}

/// A film of 4 x 2 pixels, one of them without geometry, with known numbers.
struct Known {
    Film film{4, 2, 10};
    ReferenceFilm reference{4, 2, 32};
    ShapeMap shapes{4, 2, {0, 0, 0, 0, 0, 0, 0, -1}};
    Experiment experiment;
    Known() {
        experiment.regions = {{"left", {0, 0, 1, 1}, {}}};
        for (std::size_t at = 0; at < 7; ++at) film.y[at] = reference.y[at] = 1;
        film.y[0] = 3;    // residual 2: not a firefly at k = 4
        film.y[2] = 5.5;  // residual 4.5: a firefly
        film.var[0] = 0.8f;
        film.horizon[3] = 7;
    }
};

TEST(Metrics, ReadEveryNumberOffTheFloatFilm) {
    const Known k;
    const RunMetrics run = measure(k.experiment, {"a", 10, 32, 1}, k.film, k.reference, k.shapes);
    EXPECT_DOUBLE_EQ(run.region("left")->rmse, 1);  // sqrt(4 / 4)
    EXPECT_NEAR(run.region("left")->var, 0.2, 1e-7);
    EXPECT_EQ(run.region("left")->pixels, 4u);
    EXPECT_EQ(run.fireflies, 1u);
    EXPECT_DOUBLE_EQ(run.horizon_frac, 7.0 / 70);
    EXPECT_DOUBLE_EQ(run.y_mean, (3 + 5.5 + 5) / 8);
    EXPECT_DOUBLE_EQ(run.rmse_frame, std::sqrt((4 + 4.5 * 4.5) / 8));
}

/// Of the four pixels on the left, the first and the last see the surface 1.
TEST(Metrics, OfAnObjectAreOfThePixelsThatSeeIt) {
    Known k;
    k.shapes.shape = {1, 0, 0, 0, 0, 1, 1, -1};
    k.experiment.regions[0].shape = "ball";
    k.experiment.regions[0].surface = 1;
    k.film.y[5] = 2;
    const RunMetrics run = measure(k.experiment, {"a", 10, 32, 1}, k.film, k.reference, k.shapes);
    EXPECT_EQ(run.region("left")->pixels, 2u);
    EXPECT_DOUBLE_EQ(run.region("left")->rmse, std::sqrt((4 + 1) / 2.0));
    EXPECT_NEAR(run.region("left")->var, 0.4, 1e-7);
    const AreaPixels whole({{0, 0, 3, 1}, 1}, k.shapes);
    EXPECT_EQ(whole.count(), 3u);
    EXPECT_EQ(whole.bounds(), (Box{0, 0, 2, 1}));
}

TEST(Metrics, HorizonShareIsOfAllDrawnDirections) {
    Known k;
    k.film.directions = 2;
    EXPECT_DOUBLE_EQ(measure(k.experiment, {"a", 10, 32, 1}, k.film, k.reference, k.shapes).horizon_frac, 7.0 / 140);
}

RunMetrics measured(const Experiment& e, const std::string& arm) {
    const Scene scene(e);
    ProgressMonitor monitor;
    const ReferenceFilm reference = quadrature_reference(scene, {e.s()}, monitor)[0];
    return measure(
        e, {arm, 32, e.s(), 3}, estimate_films(scene, arm, {32}, 3, "", monitor)[0], reference, shape_map(scene));
}

TEST(Metrics, DoNotDependOnTheOrderOfShapesAndLights) {
    Experiment e = test::small_scene(), other = e;
    std::rotate(other.shapes.begin(), other.shapes.begin() + 1, other.shapes.end());
    std::swap(other.disks[0], other.disks[1]);
    for (const std::string& arm : test::all_arms()) {
        if (arm.starts_with("light-") || arm.starts_with("mis-"))
            other.disks = e.disks;  // u selects among them in order
        const RunMetrics a = measured(e, arm), b = measured(other, arm);
        EXPECT_NEAR(a.y_mean / b.y_mean, 1, 1e-6) << arm;
        EXPECT_NEAR(a.rmse_frame / b.rmse_frame, 1, 1e-5) << arm;
        EXPECT_NEAR(a.regions[0].var / b.regions[0].var, 1, 1e-5) << arm;
        EXPECT_EQ(a.horizon_frac, b.horizon_frac) << arm;
        EXPECT_EQ(a.fireflies, b.fireflies) << arm;
        EXPECT_LE(a.horizon_frac, 1) << arm;
        other.disks = {e.disks[1], e.disks[0]};
    }
}

TEST(Metrics, OfOneSampleHaveNoVariance) {
    Known k;
    k.film.n = 1;
    const RunMetrics run = measure(k.experiment, {"a", 1, 32, 0}, k.film, k.reference, k.shapes);
    EXPECT_TRUE(std::isnan(run.region("left")->var));
    for (const SeedSpread& band : bands(k.experiment, {run}, nullptr)) EXPECT_NE(band.metric, "var.left");
}

TEST(Metrics, ANaNInTheFilmShowsInTheNumber) {
    Known k;
    k.film.y[1] = std::nanf("");
    EXPECT_TRUE(
        std::isnan(measure(k.experiment, {"a", 10, 32, 1}, k.film, k.reference, k.shapes).region("left")->rmse));
}

TEST(Ladders, OfArmsWithoutRowsAreLeftOut) {
    Experiment e;
    e.arms = {{"a", "cosine", {4, 16}, {}}};
    e.regions = {{"r", {0, 0, 1, 1}, {}}};
    EXPECT_TRUE(ladders(e, {}).empty());
}

/// Returns one arm with three sample counts; seed k's RMSE falls as N^slopes[k].
std::vector<Ladder> ladders_falling_as(
    const std::vector<double>& slopes, const std::vector<std::uint64_t>& sample_counts = {4, 16, 64}) {
    Experiment e;
    e.seed = 1;
    e.arms = {{"a", "cosine", sample_counts, {}}};
    e.regions = {{"r", {0, 0, 1, 1}, {}}};
    std::vector<RunMetrics> runs;
    for (std::size_t k = 0; k < slopes.size(); ++k)
        for (const std::uint64_t n : sample_counts) {
            RunMetrics run;
            run.key = {"a", n, e.s(), static_cast<std::uint32_t>(k + 1)};
            run.regions = {{"r", 8 * std::pow(static_cast<double>(n), slopes[k]), 0, 4, {}}};
            runs.push_back(run);
        }
    return ladders(e, runs);
}

TEST(Ladders, FitTheSlopeOfAPowerLaw) {
    const Ladder ladder = ladders_falling_as({-0.5})[0];
    EXPECT_NEAR(ladder.slope, -0.5, 1e-12);
    EXPECT_NEAR(ladder.high - ladder.low, 0, 1e-6);
}

TEST(Ladders, SlopeIsOfTheFirstSeedAndBandOfAll) {
    const Ladder ladder = ladders_falling_as({-0.2, -0.5, -0.6})[0];
    EXPECT_NEAR(ladder.slope, -0.2, 1e-12);
    EXPECT_NEAR(ladder.low, -0.59, 1e-12);
    EXPECT_NEAR(ladder.high, -0.23, 1e-12);
}

TEST(Ladders, OfTwoCountsAndOneSeedHaveNoInterval) {
    const Ladder ladder = ladders_falling_as({-0.5}, {4, 16})[0];
    EXPECT_NEAR(ladder.slope, -0.5, 1e-12);
    EXPECT_TRUE(std::isnan(ladder.low) && std::isnan(ladder.high));
}

/// RMSE of 64 pixels with normal errors, of prefixes of one stream as in a run: an interval that states 90 % covers the
/// slope of -1/2 in at least 88 of 100 ladders (2,000 ladders: standard error 0.7 %).
TEST(Ladders, TheIntervalOfASlopeHasItsCoverage) {
    for (const std::vector<std::uint64_t>& counts : {std::vector<std::uint64_t>{4, 16, 64}, {1, 4, 16, 64, 256}}) {
        std::mt19937_64 random(7);
        std::normal_distribution<double> normal;
        constexpr int ladders_drawn = 2000;
        int covered = 0;
        for (int k = 0; k < ladders_drawn; ++k) {
            Experiment e;
            e.seed = 1;
            e.arms = {{"a", "cosine", counts, {}}};
            e.regions = {{"r", {0, 0, 1, 1}, {}}};
            std::vector<double> sums(64);
            std::vector<RunMetrics> runs;
            std::uint64_t before = 0;
            for (const std::uint64_t n : counts) {
                double squares = 0;
                for (double& sum : sums) {
                    sum += normal(random) * std::sqrt(static_cast<double>(n - before));
                    squares += sum * sum;
                }
                before = n;
                runs.emplace_back().key = {"a", n, e.s(), 1};
                runs.back().regions = {{"r", std::sqrt(squares / 64) / static_cast<double>(n), 0, 4, {}}};
            }
            const Ladder ladder = ladders(e, runs)[0];
            covered += ladder.low <= -0.5 && -0.5 <= ladder.high;
        }
        EXPECT_GT(covered, 0.88 * ladders_drawn) << counts.size() << " sample counts";
    }
}

// 24 runs of two arms, two n, two s and three seeds, in no order.
std::vector<RunMetrics> runs_of_three_seeds() {
    std::vector<RunMetrics> runs;
    for (const std::uint32_t seed : {9u, 2u, 7u})
        for (const char* arm : {"cosine", "phong"})
            for (const std::uint64_t n : {4u, 16u})
                for (const double s : {0.0, 32.0}) runs.emplace_back().key = {arm, n, s, seed};
    return runs;
}

TEST(RunIndex, FindsEveryRunByItsKeyAndNoOther) {
    const std::vector<RunMetrics> runs = runs_of_three_seeds();
    const RunIndex index(runs);
    for (const RunMetrics& run : runs) EXPECT_EQ(index.find(run.key), &run);
    EXPECT_EQ(index.find({"phong", 4, -0.0, 7}), index.find({"phong", 4, 0.0, 7}));
    EXPECT_EQ(index.find({"phong", 4, 32, 3}), nullptr);
    EXPECT_EQ(index.find({"phong", 8, 32, 7}), nullptr);
    EXPECT_EQ(index.find({"uniform", 4, 32, 7}), nullptr);
}

TEST(RunIndex, TellsSeedsInTheOrderOfTheRuns) {
    EXPECT_EQ(RunIndex(runs_of_three_seeds()).seeds(), (std::vector<std::uint32_t>{9, 2, 7}));
    EXPECT_TRUE(RunIndex({}).seeds().empty());
}

}  // namespace metrics_test
}  // namespace crescent
