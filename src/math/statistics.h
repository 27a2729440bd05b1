// Statistics of plain numbers: moments, quantiles, distributions and their tails, exact tests, intervals of rates.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crescent::inline statistics {

// ---- Mean, standard deviation and skewness of numbers, and Student's t of their mean where they are skewed.

/// Of n numbers; sd by n - 1, the skewness by n.
struct Spread {
    double n = 0, mean = 0, sd = 0, skew = 0, largest = 0;
};
/// Mean and variance of x.
Spread spread(std::span<const double> x);
/// Johnson 1978, "Modified t Tests and Confidence Intervals for Asymmetrical Populations": t with the skewness taken
/// out.
double johnson_t(const Spread& s, double expected);

// ---- The k-th smallest of numbers, their median, and quantiles between order statistics.

/// The k-th smallest of these numbers, k from 0; there are more than k.
inline double order_statistic(std::vector<double> v, std::size_t k) {
    const auto at = v.begin() + static_cast<std::ptrdiff_t>(k);
    std::nth_element(v.begin(), at, v.end());
    return *at;
}

/// The middle one, the upper of the two where they are even in number; 0 of none.
inline double median_of(std::vector<double> v) {
    const std::size_t middle = v.size() / 2;
    return v.empty() ? 0 : order_statistic(std::move(v), middle);
}

/// Quantile q of values by linear interpolation between order statistics (R type 7); NaN where one of them is.
double quantile(std::vector<double> values, double q);

// ---- Counts of bins held against what is due in each.

/// The bin that is off by the most standard deviations.
std::size_t worst_bin(const std::vector<double>& observed, const std::vector<double>& expected);
/// What share of the draws may be too many or too few in one bin and not be seen: what takes the chi-square over all
/// bins to its level, half of the time, in the fullest of them.
double unseen_share(const std::vector<double>& expected, double degrees, double draws, double level);

// ---- How often something happened, with its interval.

/// Clopper & Pearson 1934: the 95 % interval of a rate.
std::pair<double, double> rate_interval(std::uint64_t hits, std::uint64_t of);
/// "3 of 1000 = 0.003 (95 %: 0.000619 to 0.00874)".
std::string rate_text(std::uint64_t hits, std::uint64_t of);

// ---- Tails and quantiles of the distributions that verdicts and intervals speak of, on functions.h alone: the same
// bits on every machine. Relative error below 1e-12 for counts and degrees up to 1e6 (distributions_test.cpp, beside
// Boost's).

/// Regularised incomplete gamma functions, a > 0, x >= 0: P(a, x) and Q(a, x) = 1 - P(a, x), neither by subtraction
/// where it is the small one.
double gamma_p(double a, double x);
double gamma_q(double a, double x);
/// Regularised incomplete beta function I_x(a, b), a, b > 0, for x in [0, 1] and y = 1 - x.
double beta_i(double a, double b, double x, double y);

/// P(chi^2 with so many degrees of freedom > x).
double chi_squared_tail(double degrees, double x);
/// P(|Z| > |z|), Z normal.
double normal_two_sided(double z);
/// P(|T| > |t|), Student's T with so many degrees of freedom, and the t > 0 that is exceeded with probability p.
double student_two_sided(double degrees, double t);
double student_two_sided_quantile(double degrees, double p);
/// P(N >= k), N Poisson of this mean.
double poisson_tail(double mean, double k);

/// An interval of a probability.
struct ShareInterval {
    double low, high;
};
/// Clopper & Pearson 1934: what p can be when k of n came out, each end wrong with probability alpha.
ShareInterval binomial_interval(double n, double k, double alpha);

// ---- p-values of statistics that may be infinite, or stand on nothing at all.

/// Of a chi-square statistic with so many degrees of freedom; 1 of none.
inline double chi_squared_p(double statistic, double degrees) {
    return degrees > 0 ? chi_squared_tail(degrees, statistic) : 1;
}
/// Two-sided, of a normal z; 0 of one that is not finite.
inline double normal_p(double z) { return std::isfinite(z) ? normal_two_sided(z) : 0; }
/// Two-sided, of Student's t with so many degrees of freedom; 0 of one that is not finite.
inline double student_p(double t, double degrees) { return std::isfinite(t) ? student_two_sided(degrees, t) : 0; }

// ---- Exact two-sided tests of counts: Fisher's of two shares, and the binomial one.

/// Fisher 1922: ka of na and kb of nb came out; the probability, all ka + kb being as likely on either side, of a split
/// that is no likelier than this one.
double fisher_exact(std::uint64_t ka, std::uint64_t na, std::uint64_t kb, std::uint64_t nb);

/// k of n came out where each does with probability p: twice the smaller tail, at most 1.
double binomial_exact(std::uint64_t k, std::uint64_t n, double p);

}  // namespace crescent::inline statistics
