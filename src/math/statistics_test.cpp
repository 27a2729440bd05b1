// Tails against Boost.Math's, which use other expansions.
#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "math/statistics.h"

namespace crescent {
namespace statistics_test {

constexpr double bound = 1e-12;

void near(double ours, double theirs, const char* what, double a, double x) {
    if (theirs < 1e-290) return;  // where a tail has only a few bits
    EXPECT_LE(std::fabs(ours / theirs - 1), bound)
        << what << '(' << a << ", " << x << "): " << ours << " beside " << theirs;
}

TEST(Distributions, TailsAreThoseOfBoost) {
    for (double a : {0.5, 1.0, 1.5, 3.0, 7.5, 16.0, 40.0, 250.5, 4096.0, 1e6}) {
        for (double off : {-12.0, -6.0, -3.0, -1.0, -0.1, 0.0, 0.2, 1.0, 3.0, 6.0, 15.0, 30.0}) {
            const double x = a + off * std::sqrt(a);
            if (!(x > 0)) continue;
            near(gamma_q(a, x), boost::math::gamma_q(a, x), "gamma_q", a, x);
        }
        for (double b : {0.5, 2.0, 11.0, 900.0, 1e5})
            for (double x : {1e-6, 0.01, 0.2, 0.5, 0.77, 0.99})
                near(beta_i(a, b, x, 1 - x), boost::math::ibeta(a, b, x), "beta_i", a, x);
    }
    for (double z : {0.0, 1e-3, 0.5, 1.96, 5.0, 12.0, 30.0})
        near(normal_two_sided(z), boost::math::erfc(z / std::sqrt(2.0)), "normal", z, 0);
}

TEST(Distributions, QuantilesAndIntervalsAreThoseOfBoost) {
    for (double degrees : {1.0, 4.0, 30.0, 99'999.0})
        for (double p : {0.5, 0.05, 1e-3, 1e-9}) {
            const boost::math::students_t theirs(degrees);
            const double t = boost::math::quantile(boost::math::complement(theirs, p / 2));
            near(student_two_sided_quantile(degrees, p), t, "student", degrees, p);
        }
    using Binomial = boost::math::binomial_distribution<double>;
    for (double n : {1.0, 16.0, 128.0, 4000.0})
        for (double k : {0.0, 1.0, std::floor(n / 3), n}) {
            const ShareInterval at = binomial_interval(n, k, 0.025);
            near(at.low + 1, Binomial::find_lower_bound_on_p(n, k, 0.025) + 1, "low", n, k);
            near(at.high, k < n ? Binomial::find_upper_bound_on_p(n, k, 0.025) : 1.0, "high", n, k);
        }
}

}  // namespace statistics_test

// ---- Values by integer arithmetic.

namespace statistics_test {

TEST(ExactTests, FisherSumsNoLikelierSplits) {
    EXPECT_NEAR(fisher_exact(4, 4, 0, 4), 2.0 / 70, 1e-15);
    EXPECT_NEAR(fisher_exact(3, 4, 1, 4), 0.48571428571428565, 1e-12);
    EXPECT_NEAR(fisher_exact(1, 24, 0, 24), 1, 1e-12);
    EXPECT_NEAR(fisher_exact(10, 24, 0, 24) / (2 * 1961256.0 / 6540715896.0), 1, 1e-12);
    EXPECT_NEAR(fisher_exact(1, 1, 1, 24), 2.0 / 25, 1e-12);
    EXPECT_NEAR(fisher_exact(0, 5, 0, 9), 1, 1e-15);
    EXPECT_GT(fisher_exact(500, 500, 0, 500), 0);
    EXPECT_LT(fisher_exact(500, 500, 0, 500), 1e-290);
}

TEST(ExactTests, BinomialIsTwiceTheSmallerTail) {
    EXPECT_NEAR(binomial_exact(12, 12, 0.5) / std::ldexp(1, -11), 1, 1e-12);
    EXPECT_NEAR(binomial_exact(0, 12, 0.5) / std::ldexp(1, -11), 1, 1e-12);
    EXPECT_NEAR(binomial_exact(6, 12, 0.5), 1, 1e-15);
    EXPECT_NEAR(binomial_exact(3, 4, 0.2), 2 * (4 * 0.008 * 0.8 + 0.0016), 1e-12);
    EXPECT_EQ(binomial_exact(0, 0, 0.5), 1);
}

}  // namespace statistics_test

// ---- Quantiles of sets with an obvious answer.

namespace statistics_test {

TEST(Quantiles, InterpolateBetweenOrderStatistics) {
    EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
    EXPECT_DOUBLE_EQ(quantile({5}, 0.95), 5);
    EXPECT_TRUE(std::isnan(quantile({1, std::nan("")}, 0.5)));
}

TEST(Quantiles, OfTwoMiddlesTheMedianIsTheUpper) {
    EXPECT_EQ(median_of({4, 1, 3, 2}), 3);
    EXPECT_EQ(median_of({2, 1, 3}), 2);
    EXPECT_EQ(median_of({}), 0);
}

TEST(Quantiles, AnOrderStatisticCountsFromTheSmallest) {
    EXPECT_EQ(order_statistic({4, 1, 3, 2}, 0), 1);
    EXPECT_EQ(order_statistic({4, 1, 3, 2}, 2), 3);
}

}  // namespace statistics_test

// ---- Tests and corrections against tables and published examples.

namespace statistics_test {

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

}  // namespace statistics_test

}  // namespace crescent
