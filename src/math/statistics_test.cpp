// Tails against Boost.Math's, which use other expansions.
#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <gtest/gtest.h>

#include "math/statistics.h"

namespace crescent::inline statistics {
namespace {

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
            near(gamma_p(a, x), boost::math::gamma_p(a, x), "gamma_p", a, x);
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

}  // namespace

// ---- Values by integer arithmetic.

namespace {

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

}  // namespace

// ---- Quantiles of sets with an obvious answer.

namespace {

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

}  // namespace
}  // namespace crescent::inline statistics
