// Counts of bins beside what is due in each: by Poisson's standard deviations, and by the chi-square over all of them.
#include "stats/bins.h"

#include <algorithm>
#include <cmath>

#include "stats/p_values.h"

namespace crescent::inline stats {

std::size_t worst_bin(const std::vector<double>& observed, const std::vector<double>& expected) {
    const auto off = [&](std::size_t i) {
        return std::fabs(observed[i] - expected[i]) / std::sqrt(std::max(expected[i], 1.0));
    };
    std::size_t worst = 0;
    for (std::size_t i = 1; i < observed.size(); ++i)
        if (off(i) > off(worst)) worst = i;
    return worst;
}

double unseen_share(const std::vector<double>& expected, double degrees, double draws, double level) {
    if (!(degrees > 0)) return 1;
    double low = degrees, high = 2 * degrees + 200;
    for (int i = 0; i < 40; ++i) {
        const double mid = 0.5 * (low + high);
        (chi_squared_p(mid, degrees) > level ? low : high) = mid;
    }
    const double fullest = std::max(*std::max_element(expected.begin(), expected.end()), 5.0);
    return std::min(std::sqrt((low - degrees) * fullest) / draws, 1.0);
}

}  // namespace crescent::inline stats
