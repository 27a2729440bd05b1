// Tails beside Boost.Math's, which come from other expansions.
#include "stats/distributions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

namespace crescent::inline stats {
namespace {

constexpr double bound = 1e-12;

void near(double ours, double theirs, const char* what, double a, double x) {
    if (theirs < 1e-290) return;  // where a tail is but a few bits long
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
}  // namespace crescent::inline stats
