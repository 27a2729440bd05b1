// Welch's test (Student's in pairs) with n renders of each side: its standard error falls as n^-1/2, its degrees of
// freedom rise with n - 1. What rare events could hide falls as 1/n.
#include "compare/suite/power.h"

#include <algorithm>
#include <cmath>

#include "math/hypotheses.h"

namespace crescent::inline comparison {

namespace {

constexpr std::size_t most_renders = 100000;

}  // namespace

double detectable_with(const RegionPower& power, std::size_t renders, double level) {
    const double n = static_cast<double>(renders), a = power.variance_a / n, b = power.variance_b / n;
    Welch test;
    test.se = std::sqrt(power.paired ? a : a + b);
    test.df = power.paired ? n - 1 : a + b > 0 ? (a + b) * (a + b) * (n - 1) / (a * a + b * b) : 2 * (n - 1);
    return std::max(detectable(test, level), power.missed / n);
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
