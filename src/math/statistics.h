// Statistics of plain numbers: moments, quantiles, distributions and their tails, exact tests, intervals of rates, and
// linear equations.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crescent {

// ---- Mean, standard deviation and maximum of numbers.

/// Of n numbers; sd with n - 1.
struct Spread {
    double n = 0, mean = 0, sd = 0, largest = 0;
};
/// Returns them; all 0 for no numbers.
Spread spread(std::span<const double> x);

// ---- The k-th smallest of numbers, their median, and quantiles between order statistics.

/// Returns the k-th smallest of these numbers, k from 0; there are more than k.
inline double order_statistic(std::vector<double> v, std::size_t k) {
    const auto kth = v.begin() + static_cast<std::ptrdiff_t>(k);
    std::nth_element(v.begin(), kth, v.end());
    return *kth;
}

/// Returns the middle one, the upper of the two for an even count; 0 for none.
inline double median_of(std::vector<double> v) {
    const std::size_t middle = v.size() / 2;
    return v.empty() ? 0 : order_statistic(std::move(v), middle);
}

/// Returns quantile q of values by linear interpolation between order statistics (R type 7); NaN if one of them is.
double quantile(std::vector<double> values, double q);

// ---- A rate with its interval.

/// Clopper & Pearson 1934: the 95 % interval of a rate.
std::pair<double, double> rate_interval(std::uint64_t hits, std::uint64_t trials);
/// "3 of 1000 = 0.003 (95 %: 0.000619 to 0.00874)".
std::string rate_text(std::uint64_t hits, std::uint64_t trials);

// ---- Tails and quantiles of the distributions used by checks and intervals, from functions.h alone, so the bits are
// the same on every machine; relative error below 1e-12 for counts and degrees up to 1e6 (statistics_test.cpp, against
// Boost).

/// Regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0; a small one is not computed by subtraction.
double gamma_q(double a, double x);
/// Regularised incomplete beta function I_x(a, b), a, b > 0, for x in [0, 1] and y = 1 - x.
double beta_i(double a, double b, double x, double y);

/// P(chi^2 with this many degrees of freedom > x).
double chi_squared_tail(double degrees, double x);
/// P(|Z| > |z|), Z normal.
double normal_two_sided(double z);
/// P(|T| > |t|), Student's T with this many degrees of freedom, and the t > 0 that is exceeded with probability p.
double student_two_sided(double degrees, double t);
double student_two_sided_quantile(double degrees, double p);

/// An interval of a probability.
struct ShareInterval {
    double low, high;
};
/// Clopper & Pearson 1934: the interval of p for k of n events, each end wrong with probability alpha.
ShareInterval binomial_interval(double n, double k, double alpha);

// ---- p-values of statistics that may be infinite or have no data.

/// For a chi-square statistic with this many degrees of freedom; 1 for none.
inline double chi_squared_p(double statistic, double degrees) {
    return degrees > 0 ? chi_squared_tail(degrees, statistic) : 1;
}
/// Two-sided, for Student's t with this many degrees of freedom; 0 if it is not finite.
inline double student_p(double t, double degrees) { return std::isfinite(t) ? student_two_sided(degrees, t) : 0; }

// ---- Exact two-sided tests of counts: Fisher's test of two shares, and the binomial test.

/// Fisher 1922: ka of na and kb of nb events; the probability, if all ka + kb are equally likely on either side, of a
/// split that is not more likely than this one.
double fisher_exact(std::uint64_t ka, std::uint64_t na, std::uint64_t kb, std::uint64_t nb);

/// k of n events, each with probability p: twice the smaller tail, at most 1.
double binomial_exact(std::uint64_t k, std::uint64_t n, double p);

// ---- The tail index: the generalised Pareto shape k of the largest samples. The variance is infinite from k = 1/2 on,
// the mean from k = 1 on. Zhang & Stephens 2009, "A New and Efficient Estimation Method for the Generalized Pareto
// Distribution", Technometrics 51(3), with the threshold and the weak prior of Vehtari et al. 2024, "Pareto Smoothed
// Importance Sampling", JMLR 25.

/// Pareto tail of a set of samples. Zhang & Stephens 2009; k >= 0.5: the variance is infinite, k >= 1: the mean.
struct Tail {
    double k = 0, se = 0;           // estimate and its standard error
    std::uint64_t exceedances = 0;  // number of the largest samples that were fitted
    bool heavy() const { return k >= 0.5; }
};

/// Returns how many of n samples count as tail: min(n/5, 3 sqrt(n)); 0 if that is below 5.
std::size_t tail_length(std::uint64_t n);

/// Returns k and its standard error, (1 + k)/sqrt(M) or for k < -1/2 -k/sqrt(M), from the M + 1 largest samples in
/// descending order: the last of them is the threshold. Empty if there are fewer than 6 or if they do not vary.
std::optional<Tail> fit_tail(std::span<const float> largest);
std::optional<Tail> fit_tail(std::span<const double> largest);

/// The same for samples of many pixels at once, of which a few in a thousand meet a light: the usual threshold may lie
/// among the rest, and the step up to the lit ones would look like a tail. A second fit uses an eighth of the
/// exceedances; if the two differ by more than two standard errors, the second one counts. While the tail is heavy, an
/// eighth of these are tried, and so on, and a lighter one counts: samples of plain materials lie in a few narrow
/// groups, and such a tail is not heavy at every threshold. Empty if the largest samples are equal.
std::optional<Tail> fit_pooled_tail(std::span<const float> largest);

// ---- Intervals and tests over renders: Student's t, Welch's test, Holm, Benjamini-Hochberg and Benjamini-Yekutieli.

/// P(|T| > |t|) of Student's t with df > 0 degrees of freedom.
double two_sided_p(double t, double df);
/// The t with P(T < t) = p, 0 < p < 1.
double student_quantile(double p, double df);

/// A mean over renders with its two-sided interval; NaN ends if there are fewer than two.
struct MeanInterval {
    double mean = 0, low = 0, high = 0, se = 0;
    std::size_t n = 0;
};
/// t interval of the mean; `confidence` in (0, 1), e.g. 0.95.
MeanInterval mean_interval(std::span<const double> values, double confidence);

/// Interval of a mean of counts, each of `trials` possible events; it lies in [0, trials]. Clopper & Pearson 1934 of
/// their sum, as for independent events, which is also valid if these are not equally probable (Hoeffding 1956); if the
/// counts spread more than such events would, like those of correlated pixels, the wider score interval (Wilson 1927)
/// with their own spread and Student's t.
MeanInterval count_interval(std::span<const double> counts, double trials, double confidence);

/// Welch 1947: two means with unequal variances. `p` is two-sided; equal constants have p = 1, unequal ones p = 0.
struct Welch {
    double difference = 0, se = 0, df = 0, p = 1;
};
/// Welch's test that two means are equal: t, degrees of freedom (Welch-Satterthwaite) and the two-sided p.
Welch welch_test(const MeanInterval& a, const MeanInterval& b);
/// Tests one mean against 0, for differences of pairs.
Welch paired_test(const MeanInterval& differences);
/// Returns the difference that the test detects with probability 0.9 at level alpha.
double detectable(const Welch& test, double alpha);

/// Returns the share of the sum of K squared deviations that one deviation of normal noise exceeds once in a thousand
/// sets (Grubbs 1950); 0 for fewer than three, for which no single deviation is an outlier.
double lone_share(std::size_t k);

/// Returns which hypotheses are rejected: false discoveries are at most `alpha` of them on average (Benjamini &
/// Hochberg 1995), under any dependence if `dependent` (Benjamini & Yekutieli 2001). NaN: not tested. Under the global
/// null the probability of any rejection is at most alpha.
std::vector<bool> discoveries(std::span<const double> p, double alpha, bool dependent);
/// Returns how many of the smallest p, ascending, are rejected; `tests` were tested. Those above alpha may be omitted.
std::size_t discovered(std::span<const double> rising, double tests, double alpha, bool dependent);
/// Returns the smallest alpha at which discovered() is above 0, at most 1: the p-value of "no hypothesis is false"
/// (Simes 1986).
double simes_p(std::span<const double> rising, double tests, bool dependent);
/// The same with the probability of any false one at most alpha (Holm 1979).
std::vector<bool> holm(std::span<const double> p, double alpha);

// ---- A few linear equations, such as the normal equations of least squares.

/// Gauss elimination, the largest pivot first; empty if a pivot is below `smallest_share` of its original value.
inline std::optional<std::vector<double>> solved(
    std::vector<std::vector<double>> a, std::vector<double> b, double smallest_share) {
    const std::size_t n = b.size();
    std::vector<double> size(n);
    for (std::size_t k = 0; k < n; ++k) size[k] = a[k][k];
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k; i < n; ++i)
            if (std::fabs(a[i][k]) > std::fabs(a[pivot][k])) pivot = i;
        if (!(std::fabs(a[pivot][k]) > smallest_share * size[k])) return {};
        std::swap(a[k], a[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double multiple = a[i][k] / a[k][k];
            for (std::size_t j = k; j < n; ++j) a[i][j] -= multiple * a[k][j];
            b[i] -= multiple * b[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
    return b;
}

}  // namespace crescent
