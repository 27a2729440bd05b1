// Two passes: the mean, then powers of what each number differs from it by.
#include "stats/moments.h"

#include <algorithm>
#include <cmath>

namespace crescent::inline stats {

Spread spread(std::span<const double> x) {
    Spread s;
    s.n = static_cast<double>(x.size());
    for (double v : x) {
        s.mean += v / s.n;
        s.largest = std::max(s.largest, v);
    }
    double m2 = 0, m3 = 0;
    for (double v : x) {
        const double d = v - s.mean;
        m2 += d * d;
        m3 += d * d * d;
    }
    s.sd = std::sqrt(m2 / std::max(s.n - 1, 1.0));
    s.skew = s.sd > 0 ? m3 / s.n / (s.sd * s.sd * s.sd) : 0;
    return s;
}

double johnson_t(const Spread& s, double expected) {
    const double d = s.mean - expected;
    if (!(s.sd > 1e-7 * std::fabs(expected)))
        return std::fabs(d) <= 1e-5 * std::fabs(expected) ? 0 : 1e9;  // every sample alike
    const double corrected = d + s.skew * s.sd / (6 * s.n) + s.skew / (3 * s.sd) * d * d;
    return corrected * std::sqrt(s.n) / s.sd;
}

}  // namespace crescent::inline stats
