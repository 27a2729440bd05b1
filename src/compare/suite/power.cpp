// With s1 and s2 the estimated over the true standard error, now and in the repetition, the repetition finds c s1 if
// c s1 + Z > t s2, Z normal. By normal approximation of s (mean 1 - 1/(4 df), variance 1/(2 df)) this has a probability
// of 90 % if c m1 - t m2 = z sqrt(1 + c^2/(2 df1) + t^2/(2 df2)), z = 1.2816: a quadratic equation for c. Against
// simulation c is right to 1 % from 10 degrees of freedom on, and too large by 10 % with 3. The standard error falls as
// n^-1/2 with n renders, what rare events could hide as 1/n.
#include "compare/suite/power.h"

#include <algorithm>
#include <cmath>

namespace crescent::inline comparison {

namespace {

constexpr std::size_t most_renders = 100000;

}  // namespace

double found_difference(const Welch& test, double estimate_df, double level) {
    if (!(test.df > 0) || !(estimate_df > 0) || !std::isfinite(test.se)) return HUGE_VAL;
    constexpr double z = 1.2815515655446004;  // P(Z < z) = 0.9
    const double t = student_quantile(1 - level / 2, test.df);
    const double m1 = 1 - 1 / (4 * estimate_df), m2 = 1 - 1 / (4 * test.df);
    const double a = m1 * m1 - z * z / (2 * estimate_df), b = m1 * m2 * t,
                 c = m2 * m2 * t * t - z * z * (1 + t * t / (2 * test.df));
    const double root = b * b - a * c;
    return a > 0 && root >= 0 ? test.se * (b + std::sqrt(root)) / a : HUGE_VAL;
}

double detectable_with(const RegionPower& power, std::size_t renders, double level) {
    const double n = static_cast<double>(renders), a = power.variance_a / n, b = power.variance_b / n;
    Welch test;
    test.se = std::sqrt(power.paired ? a : a + b);
    test.df = power.paired ? n - 1 : a + b > 0 ? (a + b) * (a + b) * (n - 1) / (a * a + b * b) : 2 * (n - 1);
    return std::max(found_difference(test, power.estimate_df, level), power.missed / n);
}

std::optional<std::size_t> renders_needed(const RegionPower& power, double smallest, double level) {
    const double limit = smallest * power.mean;
    const auto enough = [&](std::size_t n) { return detectable_with(power, n, level) <= limit; };
    if (!(limit > 0) || !enough(most_renders)) return {};
    std::size_t low = 1, high = most_renders;  // too few, enough
    while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        (enough(middle) ? high : low) = middle;
    }
    return high;
}

}  // namespace crescent::inline comparison
