// Mean, standard deviation and skewness of numbers, and Student's t of their mean where they are skewed.
#pragma once

#include <span>

namespace crescent::inline stats {

/// Of n numbers; sd by n - 1, the skewness by n.
struct Spread {
    double n = 0, mean = 0, sd = 0, skew = 0, largest = 0;
};
/// Mean and variance of x.
Spread spread(std::span<const double> x);
/// Johnson 1978, "Modified t Tests and Confidence Intervals for Asymmetrical Populations": t with the skewness taken
/// out.
double johnson_t(const Spread& s, double expected);

}  // namespace crescent::inline stats
