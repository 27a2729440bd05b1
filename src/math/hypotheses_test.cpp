// Tests and corrections against tables and published examples.
#include "math/hypotheses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace crescent::inline statistics {
namespace {

TEST(Hypotheses, KnowStudentsT) {
    EXPECT_NEAR(two_sided_p(2.228139, 10), 0.05, 1e-6);  // tables of Student's t
    EXPECT_NEAR(student_quantile(0.975, 4), 2.776445, 1e-6);
    const std::vector<double> values{1, 2, 3, 4};
    const MeanInterval m = mean_interval(values, 0.95);
    EXPECT_DOUBLE_EQ(m.mean, 2.5);
    EXPECT_NEAR(m.high - m.mean, 3.182446 * std::sqrt(5.0 / 3 / 4), 1e-6);
}

TEST(Hypotheses, AnIntervalOfCountsLiesBetween0AndAll) {
    // Clopper & Pearson of 0 and of 4 in 400 (tables: 0 to 0.0092, 0.0027 to 0.0254), as counts per 100.
    const MeanInterval none = count_interval(std::vector<double>{0, 0, 0, 0}, 100, 0.95);
    EXPECT_EQ(none.low, 0);
    EXPECT_NEAR(none.high, 0.918, 1e-3);
    const MeanInterval few = count_interval(std::vector<double>{1, 1, 1, 1}, 100, 0.95);
    EXPECT_NEAR(few.low, 0.273, 1e-3);
    EXPECT_NEAR(few.high, 2.541, 1e-3);
    for (const std::vector<double>& counts : {std::vector<double>{0, 0, 0, 5}, {100, 100, 2}, {0, 1}, {100, 100}}) {
        const MeanInterval m = count_interval(counts, 100, 0.95);
        EXPECT_GE(m.low, 0);
        EXPECT_LE(m.low, m.mean);
        EXPECT_GE(m.high, m.mean);
        EXPECT_LE(m.high, 100);
    }
    EXPECT_LT(mean_interval(std::vector<double>{0, 0, 0, 5}, 0.95).low, 0);
}

/// Returns how often the interval of counts contains their expectation.
template <class Count> double counts_covered(Count count, double expected) {
    std::mt19937_64 random(1);
    int held = 0;
    constexpr int repeats = 2000;
    for (int i = 0; i < repeats; ++i) {
        std::vector<double> counts(6);
        for (double& c : counts) c = count(random);
        const MeanInterval m = count_interval(counts, 1024, 0.95);
        held += m.low <= expected && expected <= m.high;
    }
    return held / static_cast<double>(repeats);
}

TEST(Hypotheses, AnIntervalOfCountsHoldsTheirExpectation) {
    const double least = 0.95 - 3 * std::sqrt(0.95 * 0.05 / 2000);
    for (const double p : {1e-4, 1e-3, 0.02, 0.5, 0.999})  // independent pixels
        EXPECT_GE(counts_covered([&](auto& r) { return std::binomial_distribution(1024, p)(r); }, 1024 * p), least)
            << p;
    for (const double p : {0.02, 0.2, 0.5})  // fireflies of sixteen pixels at once
        EXPECT_GE(counts_covered([&](auto& r) { return 16 * std::binomial_distribution(64, p)(r); }, 1024 * p), least)
            << p;
}

TEST(Hypotheses, AgreeWithWelchsOwnExample) {
    const std::vector<double> a{
        27.5, 21.0, 19.0, 23.6, 17.0, 17.9, 16.9, 20.1, 21.9, 22.6, 23.1, 19.6, 19.0, 21.7, 21.4},
        b{27.1, 22.0, 20.8, 23.4, 23.4, 23.5, 25.8, 22.0, 24.8, 20.2, 21.9, 22.1, 22.9, 30.5, 24.4};
    const Welch w = welch_test(mean_interval(a, 0.95), mean_interval(b, 0.95));
    EXPECT_NEAR(w.difference / w.se, -2.85, 0.02);
    EXPECT_NEAR(w.df, 28, 0.5);
    EXPECT_NEAR(w.p, 0.0081, 3e-4);
}

TEST(Hypotheses, DiscoverWhatBenjaminiAndHochbergDo) {
    const std::vector<double> p{0.001, 0.008, 0.039, 0.041, 0.042, 0.06, 0.074, 0.205, std::nan("")};
    EXPECT_EQ(
        discoveries(p, 0.05, false), (std::vector<bool>{true, true, false, false, false, false, false, false, false}));
    EXPECT_EQ(holm(p, 0.05), (std::vector<bool>{true, false, false, false, false, false, false, false, false}));
    const std::vector<bool> careful = discoveries(p, 0.05, true);
    EXPECT_EQ(std::count(careful.begin(), careful.end(), true), 1);
}

TEST(Hypotheses, ALoneDeviationIsWhatGrubbsCallsAnOutlier) {
    // Grubbs 1950, upper one-sided critical value at 0.001 for n = 10: 2.606 standard deviations.
    EXPECT_NEAR(std::sqrt(lone_share(10) * 9), 2.606, 2e-3);
    EXPECT_EQ(lone_share(2), 0);
}

}  // namespace
}  // namespace crescent::inline statistics
