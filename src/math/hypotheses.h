// Intervals and tests over renders: Student's t, Welch's test, Holm, Benjamini-Hochberg and Benjamini-Yekutieli.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace crescent::inline statistics {

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

/// Interval of a mean of counts, each of `of` possible events; it lies in [0, of]. Clopper & Pearson 1934 of their sum,
/// as for independent events, which is also valid if these are not equally probable (Hoeffding 1956); if the counts
/// spread more than such events would, like those of correlated pixels, the wider score interval (Wilson 1927) with
/// their own spread and Student's t.
MeanInterval count_interval(std::span<const double> counts, double of, double confidence);

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
/// Returns how many of the smallest p, ascending, are rejected; `of` were tested. Those above alpha may be omitted.
std::size_t discovered(std::span<const double> rising, double of, double alpha, bool dependent);
/// The same with the probability of any false one at most alpha (Holm 1979).
std::vector<bool> holm(std::span<const double> p, double alpha);

}  // namespace crescent::inline statistics
