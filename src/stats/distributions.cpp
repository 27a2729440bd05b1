// Series and continued fractions of the incomplete gamma and beta functions (Abramowitz & Stegun 6.5.29, 6.5.31,
// 26.5.8, the fractions by the method of Lentz), with what stands before them as a density in the form of C. Loader
// 2000, "Fast and accurate computation of binomial probabilities": Stirling's error and the deviance keep every digit
// where logarithms of gamma functions would cancel.
#include "stats/distributions.h"

#include <cmath>
#include <limits>

#include "math/functions.h"

namespace crescent::inline stats {

namespace {

constexpr double two_pi = 6.283185307179586477, tiny = 1e-300, close = 1e-16;
constexpr int most_terms = 1'000'000;

/// ln Gamma(n + 1) - (n + 1/2) ln n + n - ln(2 pi)/2, n > 0.
double stirling_error(double n) {
    double below = 0;
    for (; n < 16; n += 1) below += (n + 0.5) * math::log1p(1 / n) - 1;
    const double z = 1 / (n * n);
    const double far = 1.0 / 1260 - z * (1.0 / 1680 - z * (1.0 / 1188 - z * (691.0 / 360360)));
    return below + (1.0 / 12 - z * (1.0 / 360 - z * far)) / n;
}

/// x ln(x/m) + m - x, without cancellation near x = m.
double deviance(double x, double m) {
    const double off = x - m, v = off / (x + m);
    if (!(std::fabs(v) < 0.1)) return x * math::log(x / m) - off;
    double sum = off * v, term = 2 * x * v;
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

/// 1/(b + a1/(b1 + a2/(b2 + ...))): `step(k, a, b)` gives the k-th pair.
template <class Step> double fraction(double b, Step step) {
    double c = 1 / tiny, d = 1 / away_from_0(b), h = d;
    for (int k = 1; k < most_terms; ++k) {
        double over, under;
        step(k, over, under);
        d = 1 / away_from_0(under + over * d);
        c = away_from_0(under + over / c);
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
    const double f = fraction(x + 1 - a, [&](int k, double& over, double& under) {
        over = -k * (k - a);
        under = x + 2 * k + 1 - a;
    });
    return poisson_density(a, x) * a * f;
}

double beta_fraction(double a, double b, double x, double y) {
    const double f = fraction(1, [&](int k, double& over, double& under) {
        const int m = k / 2;
        const double at = a + 2 * m;
        over = k & 1 ? -(a + m) * (a + b + m) * x / (at * (at + 1)) : m * (b - m) * x / ((at - 1) * at);
        under = 1;
    });
    return binomial_density(a, b, x, y) * b / (a + b) * f;
}

/// Where a function that rises over [low, high] passes a value, to the last bit.
template <class Function> double passes(Function f, double value, double low, double high) {
    for (;;) {
        const double middle = low + 0.5 * (high - low);
        if (!(middle > low && middle < high)) return middle;
        (f(middle) < value ? low : high) = middle;
    }
}

}  // namespace

double gamma_p(double a, double x) {
    if (!(x > 0)) return 0;
    return x < a + 1 ? gamma_series(a, x) : 1 - gamma_q(a, x);
}

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

double poisson_tail(double mean, double k) { return k > 0 ? gamma_p(k, mean) : 1; }

ShareInterval binomial_interval(double n, double k, double alpha) {
    const double low = k > 0 ? passes([&](double p) { return beta_i(k, n - k + 1, p, 1 - p); }, alpha, 0, 1) : 0;
    const double high = k < n ? passes([&](double p) { return beta_i(k + 1, n - k, p, 1 - p); }, 1 - alpha, 0, 1) : 1;
    return {low, high};
}

}  // namespace crescent::inline stats
