// Two passes: the mean, then powers of each number's difference from it.
#include "math/statistics.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <vector>

#include "base/errors.h"
#include "math/functions.h"

namespace crescent {

Spread spread(std::span<const double> x) {
    Spread s;
    s.n = static_cast<double>(x.size());
    for (double v : x) {
        s.mean += v / s.n;
        s.largest = std::max(s.largest, v);
    }
    double m2 = 0;
    for (double v : x) m2 += (v - s.mean) * (v - s.mean);
    s.sd = std::sqrt(m2 / std::max(s.n - 1, 1.0));
    return s;
}

// ---- Quantiles of a few numbers: sorted, with linear interpolation between two neighbours.

double quantile(std::vector<double> values, double q) {
    ensure(!values.empty(), "a quantile of something");
    if (std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) return std::nan("");
    std::sort(values.begin(), values.end());
    const double rank = q * static_cast<double>(values.size() - 1);
    const std::size_t lower = static_cast<std::size_t>(rank);
    const std::size_t upper = std::min(lower + 1, values.size() - 1);
    const double t = rank - static_cast<double>(lower);
    return t == 0 ? values[lower] : values[lower] + t * (values[upper] - values[lower]);
}

// ---- Rates with exact binomial intervals.

std::pair<double, double> rate_interval(std::uint64_t hits, std::uint64_t trials) {
    if (trials == 0) return {0, 1};
    const ShareInterval p = binomial_interval(static_cast<double>(trials), static_cast<double>(hits), 0.025);
    return {p.low, p.high};
}

std::string rate_text(std::uint64_t hits, std::uint64_t trials) {
    const auto [low, high] = rate_interval(hits, trials);
    return fmt::format("{} of {} = {:.3g} (95 %: {:.3g} to {:.3g})", hits, trials,
        trials ? static_cast<double>(hits) / static_cast<double>(trials) : 0.0, low, high);
}

// ---- Series and continued fractions of the incomplete gamma and beta functions (Abramowitz & Stegun 6.5.29, 6.5.31,
// 26.5.8, the fractions by the method of Lentz). The factors before them are densities in the form of C. Loader 2000,
// "Fast and accurate computation of binomial probabilities": Stirling's error and the deviance keep every digit where
// logarithms of gamma functions would cancel.

namespace {

constexpr double two_pi = 6.283185307179586477, tiny = 1e-300, close = 1e-16;
constexpr int most_terms = 1'000'000;

/// ln Gamma(n + 1) - (n + 1/2) ln n + n - ln(2 pi)/2, n > 0.
double stirling_error(double n) {
    double sum = 0;
    for (; n < 16; n += 1) sum += (n + 0.5) * math::log1p(1 / n) - 1;
    const double z = 1 / (n * n);
    const double tail = 1.0 / 1260 - z * (1.0 / 1680 - z * (1.0 / 1188 - z * (691.0 / 360360)));
    return sum + (1.0 / 12 - z * (1.0 / 360 - z * tail)) / n;
}

/// x ln(x/m) + m - x, without cancellation near x = m.
double deviance(double x, double m) {
    const double deviation = x - m, v = deviation / (x + m);
    if (!(std::fabs(v) < 0.1)) return x * math::log(x / m) - deviation;
    double sum = deviation * v, term = 2 * x * v;
    for (int k = 3;; k += 2) {
        const double next = sum + (term *= v * v) / k;
        if (next == sum) return sum;
        sum = next;
    }
}

/// m^x e^-m / Gamma(x + 1).
double poisson_density(double x, double m) {
    return math::exp(-stirling_error(x) - deviance(x, m)) / std::sqrt(two_pi * x);
}

/// Gamma(a + b + 1)/(Gamma(a + 1) Gamma(b + 1)) x^a y^b.
double binomial_density(double a, double b, double x, double y) {
    const double n = a + b;
    const double error = stirling_error(n) - stirling_error(a) - stirling_error(b);
    return math::exp(error - deviance(a, n * x) - deviance(b, n * y)) * std::sqrt(n / (two_pi * a * b));
}

double away_from_0(double x) { return std::fabs(x) < tiny ? tiny : x; }

/// 1/(b + a1/(b1 + a2/(b2 + ...))): `step(k, a, b)` sets the k-th pair.
template <class Step> double fraction(double b, Step step) {
    double c = 1 / tiny, d = 1 / away_from_0(b), h = d;
    for (int k = 1; k < most_terms; ++k) {
        double numerator, denominator;
        step(k, numerator, denominator);
        d = 1 / away_from_0(denominator + numerator * d);
        c = away_from_0(denominator + numerator / c);
        h *= d * c;
        if (std::fabs(d * c - 1) < close) break;
    }
    return h;
}

double gamma_series(double a, double x) {
    double sum = 1, term = 1;
    for (int k = 1; k < most_terms; ++k) {
        sum += term *= x / (a + k);
        if (term < sum * close) break;
    }
    return poisson_density(a, x) * sum;
}

double gamma_fraction(double a, double x) {
    const double f = fraction(x + 1 - a, [&](int k, double& numerator, double& denominator) {
        numerator = -k * (k - a);
        denominator = x + 2 * k + 1 - a;
    });
    return poisson_density(a, x) * a * f;
}

double beta_fraction(double a, double b, double x, double y) {
    const double f = fraction(1, [&](int k, double& numerator, double& denominator) {
        const int m = k / 2;
        const double order = a + 2 * m;
        numerator =
            k & 1 ? -(a + m) * (a + b + m) * x / (order * (order + 1)) : m * (b - m) * x / ((order - 1) * order);
        denominator = 1;
    });
    return binomial_density(a, b, x, y) * b / (a + b) * f;
}

/// Finds where an increasing function on [low, high] passes a value, to the last bit.
template <class Function> double passes(Function f, double value, double low, double high) {
    for (;;) {
        const double middle = low + 0.5 * (high - low);
        if (!(middle > low && middle < high)) return middle;
        (f(middle) < value ? low : high) = middle;
    }
}

}  // namespace

double gamma_q(double a, double x) {
    if (!(x > 0)) return 1;
    if (x == std::numeric_limits<double>::infinity()) return 0;
    return x < a + 1 ? 1 - gamma_series(a, x) : gamma_fraction(a, x);
}

double beta_i(double a, double b, double x, double y) {
    if (!(x > 0)) return 0;
    if (!(y > 0)) return 1;
    return x * (a + b + 2) < a + 1 ? beta_fraction(a, b, x, y) : 1 - beta_fraction(b, a, y, x);
}

double chi_squared_tail(double degrees, double x) { return gamma_q(0.5 * degrees, 0.5 * x); }

double normal_two_sided(double z) { return gamma_q(0.5, 0.5 * z * z); }

double student_two_sided(double degrees, double t) {
    const double t2 = t * t;
    if (t2 == std::numeric_limits<double>::infinity()) return 0;
    return beta_i(0.5 * degrees, 0.5, degrees / (degrees + t2), t2 / (degrees + t2));
}

double student_two_sided_quantile(double degrees, double p) {
    double high = 1;
    while (student_two_sided(degrees, high) > p) high *= 2;
    return passes([&](double t) { return -student_two_sided(degrees, t); }, -p, 0, high);
}

ShareInterval binomial_interval(double n, double k, double alpha) {
    const double low = k > 0 ? passes([&](double p) { return beta_i(k, n - k + 1, p, 1 - p); }, alpha, 0, 1) : 0;
    const double high = k < n ? passes([&](double p) { return beta_i(k + 1, n - k, p, 1 - p); }, 1 - alpha, 0, 1) : 1;
    return {low, high};
}

// ---- Hypergeometric probabilities by the ratio of neighbours from one end, so that no factorial is needed; binomial
// tails by the incomplete beta function.

double fisher_exact(std::uint64_t ka, std::uint64_t na, std::uint64_t kb, std::uint64_t nb) {
    const std::uint64_t k = ka + kb, low = k > nb ? k - nb : 0, high = std::min(k, na);
    // P(i + 1)/P(i) = (na - i)(k - i) / ((i + 1)(nb - k + i + 1)). The largest is kept at 1, so nothing overflows.
    std::vector<double> weight{1};
    const auto d = [](std::uint64_t x) { return static_cast<double>(x); };
    for (std::uint64_t i = low; i < high; ++i) {
        weight.push_back(weight.back() * d(na - i) * d(k - i) / (d(i + 1) * d(nb + i + 1 - k)));
        if (weight.back() > 1)
            for (const double top = weight.back(); double& w : weight) w /= top;
    }
    constexpr double slack = 1 + 1e-9;  // outcomes with equal probability differ by rounding
    const double threshold = weight[ka - low] * slack;
    double total = 0, extreme = 0;
    for (const double w : weight) {
        total += w;
        extreme += w <= threshold ? w : 0;
    }
    return std::min(1.0, extreme / total);
}

double binomial_exact(std::uint64_t k, std::uint64_t n, double p) {
    if (n == 0) return 1;
    const double kd = static_cast<double>(k), nd = static_cast<double>(n);
    const double upper_tail = k == 0 ? 1 : beta_i(kd, nd - kd + 1, p, 1 - p);  // P(N >= k)
    const double lower_tail = k == n ? 1 : beta_i(nd - kd, kd + 1, 1 - p, p);  // P(N <= k)
    return std::min(1.0, 2 * std::min(upper_tail, lower_tail));
}

// ---- The generalised Pareto index k of the largest samples: Zhang & Stephens 2009, with the prior of Vehtari et al.
// 2024, ten exceedances at k = 1/2. Its standard error is that of maximum likelihood, (1 + k)/sqrt(n), where k > -1/2.

namespace {

/// The mean of ln(1 - theta v), with one logarithm for a product of many factors, taken before the product leaves the
/// range of doubles (a factor is below 1e108 for any two floats).
double mean_log1p(const std::vector<double>& x, double theta) {
    double sum = 0, product = 1;
    for (double v : x) {
        product *= 1 - theta * v;
        if (product > 1e-200 && product < 1e200) continue;
        sum += math::log(product);
        product = 1;
    }
    return (sum + math::log(product)) / static_cast<double>(x.size());
}

/// Zhang & Stephens' posterior mean of theta = -k/sigma over a grid, x ascending.
double posterior_theta(const std::vector<double>& x) {
    const double n = static_cast<double>(x.size());
    const int grid = 30 + static_cast<int>(std::sqrt(n));
    const double quartile = x[static_cast<std::size_t>(n / 4 + 0.5) - 1];
    std::vector<double> theta, likelihood;
    for (int j = 1; j <= grid; ++j) {
        const double t = 1 / x.back() + (1 - std::sqrt(grid / (j - 0.5))) / (3 * quartile);
        const double k = mean_log1p(x, t);
        theta.push_back(t);
        likelihood.push_back(n * (math::log(-t / k) - k - 1));
    }
    double sum = 0, weights = 0;
    const double top = *std::max_element(likelihood.begin(), likelihood.end());
    for (std::size_t j = 0; j < theta.size(); ++j) {
        const double w = math::exp(likelihood[j] - top);
        if (!(w > 0)) continue;
        sum += w * theta[j];
        weights += w;
    }
    return sum / weights;
}

template <class T> std::optional<Tail> fit(std::span<const T> largest) {
    if (largest.size() < 6) return {};
    const double threshold = static_cast<double>(largest.back());
    std::vector<double> x;
    for (std::size_t i = largest.size() - 1; i-- > 0;) x.push_back(static_cast<double>(largest[i]) - threshold);
    const double spread = 1e-5 * std::fabs(threshold);  // equal float samples differ only by rounding
    if (!std::isfinite(x.back()) || !(x.back() > spread)) return {};
    std::erase_if(x, [spread](double v) { return !(v > spread); });  // ties at the threshold
    if (x.size() < 5) return {};
    const double n = static_cast<double>(x.size());
    constexpr double prior = 10;  // pseudo-exceedances at k = 1/2
    const double k = (n * mean_log1p(x, posterior_theta(x)) + prior * 0.5) / (n + prior);
    // The likelihood is regular for k > -1/2; below, the standard error is the spread of the mean logarithm, which k
    // is.
    return Tail{k, std::max(1 + k, -k) / std::sqrt(n), x.size()};
}

}  // namespace

std::size_t tail_length(std::uint64_t n) {
    const double size = static_cast<double>(n);
    const double length = std::floor(std::min(size / 5, 3 * std::sqrt(size)));
    return length < 5 ? 0 : static_cast<std::size_t>(length);
}

std::optional<Tail> fit_tail(std::span<const float> largest) { return fit(largest); }
std::optional<Tail> fit_tail(std::span<const double> largest) { return fit(largest); }

std::optional<Tail> fit_pooled_tail(std::span<const float> largest) {
    std::optional<Tail> out = fit_tail(largest);
    const std::size_t first_deeper = largest.empty() ? 0 : (largest.size() - 1) / 8;
    for (std::size_t exceedances = first_deeper; out && exceedances >= 5; exceedances /= 8) {
        const bool is_first = exceedances == first_deeper;
        if (!is_first && !out->heavy()) break;
        const std::optional<Tail> deeper = fit_tail(largest.first(1 + exceedances));
        if (!deeper) return {};  // the largest are equal
        const bool differ = std::fabs(out->k - deeper->k) > 2 * math::hypot(out->se, deeper->se);
        if (differ && (is_first || deeper->k < out->k)) out = deeper;
    }
    return out;
}

// ---- Welch 1947 with the degrees of Welch and Satterthwaite, Holm 1979, Benjamini & Hochberg 1995 and, for dependent
// tests, Benjamini & Yekutieli 2001. Without any spread, p = 1 if the means are equal and 0 if not.

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
    Welch w{.difference = difference, .se = se, .df = df, .p = 1};
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
    out.low = out.mean - t * out.se;
    out.high = out.mean + t * out.se;
    return out;
}

MeanInterval count_interval(std::span<const double> counts, double trials, double confidence) {
    MeanInterval out = mean_interval(counts, confidence);
    if (out.n < 2) return out;
    const double check_cases = static_cast<double>(out.n) * trials, p = out.mean / trials;
    const ShareInterval independent = binomial_interval(check_cases, std::round(p * check_cases), (1 - confidence) / 2);
    // |p' - p| = t se' at both ends, where the standard error of p' is that of p scaled as a binomial's, p' (1 - p').
    double low = p, high = p;
    if (p > 0 && p < 1) {
        const double t_se = student_quantile(0.5 + confidence / 2, static_cast<double>(out.n - 1)) * out.se / trials;
        const double c = t_se * t_se / (p * (1 - p));
        const double middle = (p + c / 2) / (1 + c), half = std::sqrt(t_se * t_se + c * c / 4) / (1 + c);
        low = middle - half;
        high = middle + half;
    }
    out.low = std::max(0.0, trials * std::min(low, independent.low));
    out.high = std::min(trials, trials * std::max(high, independent.high));
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

namespace {

/// 1 + 1/2 + ... + 1/tests under any dependence, else 1.
double dependence_factor(double tests, bool dependent) {
    double harmonic = 1;
    for (double i = 2; dependent && i <= tests; ++i) harmonic += 1 / i;
    return harmonic;
}

}  // namespace

double simes_p(std::span<const double> p, double tests, bool dependent) {
    const double factor = tests * dependence_factor(tests, dependent);
    double out = 1;
    for (std::size_t i = 0; i < p.size(); ++i) out = std::min(out, p[i] * factor / static_cast<double>(i + 1));
    return out;
}

std::size_t discovered(std::span<const double> p, double tests, double alpha, bool dependent) {
    const double harmonic = dependence_factor(tests, dependent);
    std::size_t last = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
        if (p[i] <= alpha * static_cast<double>(i + 1) / (tests * harmonic)) last = i + 1;
    return last;
}

std::vector<bool> discoveries(std::span<const double> p, double alpha, bool dependent) {
    const std::vector<std::size_t> order = rising(p);
    std::vector<double> values;
    for (const std::size_t i : order) values.push_back(p[i]);
    const std::size_t last = discovered(values, static_cast<double>(order.size()), alpha, dependent);
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

}  // namespace crescent
