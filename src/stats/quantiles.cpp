// Quantiles of a few numbers: sorted, and a straight line between two neighbours.
#include "stats/quantiles.h"

#include <cmath>

#include "base/errors.h"

namespace crescent::inline stats {

double quantile(std::vector<double> values, double q) {
    ensure(!values.empty(), "a quantile of something");
    if (std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) return std::nan("");
    std::sort(values.begin(), values.end());
    const double at = q * static_cast<double>(values.size() - 1);
    const std::size_t below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    const double t = at - static_cast<double>(below);
    return t == 0 ? values[below] : values[below] + t * (values[above] - values[below]);
}

}  // namespace crescent::inline stats
