// Welch 1947 with the degrees of Welch and Satterthwaite, Holm 1979, Benjamini & Hochberg 1995 and, for dependent
// tests, Benjamini & Yekutieli 2001. Without any spread, p = 1 if the means are equal and 0 if not.
#include "math/hypotheses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "math/statistics.h"

namespace crescent::inline statistics {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Returns the indices of the finite p values, ascending.
std::vector<std::size_t> rising(std::span<const double> p) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < p.size(); ++i)
        if (std::isfinite(p[i])) order.push_back(i);
    std::sort(
        order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] != p[b] ? p[a] < p[b] : a < b; });
    return order;
}

Welch checked(double difference, double se, double df) {
    Welch w{difference, se, df, 1};
    if (!std::isfinite(difference) || !std::isfinite(se)) w.p = nan;
    else if (se > 0) w.p = two_sided_p(difference / se, df);
    else w.p = difference == 0 ? 1 : 0;
    return w;
}

}  // namespace

double two_sided_p(double t, double df) {
    if (!(df > 0) || std::isnan(t)) return nan;
    return student_two_sided(df, std::fabs(t));
}

double student_quantile(double p, double df) {
    return p >= 0.5 ? student_two_sided_quantile(df, 2 * (1 - p)) : -student_two_sided_quantile(df, 2 * p);
}

MeanInterval mean_interval(std::span<const double> values, double confidence) {
    MeanInterval out;
    out.n = values.size();
    const double n = static_cast<double>(out.n);
    out.mean = out.n ? std::accumulate(values.begin(), values.end(), 0.0) / n : nan;
    out.low = out.high = out.se = nan;
    if (out.n < 2) return out;
    double squares = 0;
    for (const double v : values) squares += (v - out.mean) * (v - out.mean);
    out.se = std::sqrt(squares / (n - 1) / n);
    const double t = student_quantile(0.5 + confidence / 2, n - 1);
    out.low = out.mean - t * out.se, out.high = out.mean + t * out.se;
    return out;
}

MeanInterval count_interval(std::span<const double> counts, double of, double confidence) {
    MeanInterval out = mean_interval(counts, confidence);
    if (out.n < 2) return out;
    const double check_cases = static_cast<double>(out.n) * of, p = out.mean / of;
    const ShareInterval independent = binomial_interval(check_cases, std::round(p * check_cases), (1 - confidence) / 2);
    // |p' - p| = t se' at both ends, where the standard error of p' is that of p scaled as a binomial's, p' (1 - p').
    double low = p, high = p;
    if (p > 0 && p < 1) {
        const double t_se = student_quantile(0.5 + confidence / 2, static_cast<double>(out.n - 1)) * out.se / of;
        const double c = t_se * t_se / (p * (1 - p));
        const double middle = (p + c / 2) / (1 + c), half = std::sqrt(t_se * t_se + c * c / 4) / (1 + c);
        low = middle - half, high = middle + half;
    }
    out.low = std::max(0.0, of * std::min(low, independent.low));
    out.high = std::min(of, of * std::max(high, independent.high));
    return out;
}

Welch welch_test(const MeanInterval& a, const MeanInterval& b) {
    const double va = a.se * a.se, vb = b.se * b.se, sum = va + vb;
    const double denominator = va * va / static_cast<double>(a.n - 1) + vb * vb / static_cast<double>(b.n - 1);
    return checked(a.mean - b.mean, std::sqrt(sum), denominator > 0 ? sum * sum / denominator : 1);
}

Welch paired_test(const MeanInterval& differences) {
    return checked(differences.mean, differences.se, std::max(1.0, static_cast<double>(differences.n) - 1));
}

double detectable(const Welch& test, double alpha) {
    if (!(test.df > 0) || !std::isfinite(test.se)) return std::numeric_limits<double>::infinity();
    return test.se * (student_quantile(1 - alpha / 2, test.df) + student_quantile(0.9, test.df));
}

double lone_share(std::size_t count) {
    if (count < 3) return 0;
    constexpr double level = 1e-3;
    const double k = static_cast<double>(count), t = student_quantile(1 - level / k, k - 2);
    return (k - 1) / k * t * t / (k - 2 + t * t);
}

std::size_t discovered(std::span<const double> p, double of, double alpha, bool dependent) {
    double harmonic = 1;
    for (double i = 2; dependent && i <= of; ++i) harmonic += 1 / i;
    std::size_t last = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
        if (p[i] <= alpha * static_cast<double>(i + 1) / (of * harmonic)) last = i + 1;
    return last;
}

std::vector<bool> discoveries(std::span<const double> p, double alpha, bool dependent) {
    const std::vector<std::size_t> order = rising(p);
    std::vector<double> sorted;
    for (const std::size_t i : order) sorted.push_back(p[i]);
    const std::size_t last = discovered(sorted, static_cast<double>(order.size()), alpha, dependent);
    std::vector<bool> out(p.size());
    for (std::size_t i = 0; i < last; ++i) out[order[i]] = true;
    return out;
}

std::vector<bool> holm(std::span<const double> p, double alpha) {
    const std::vector<std::size_t> order = rising(p);
    std::vector<bool> out(p.size());
    for (std::size_t i = 0; i < order.size() && p[order[i]] <= alpha / static_cast<double>(order.size() - i); ++i)
        out[order[i]] = true;
    return out;
}

}  // namespace crescent::inline statistics
