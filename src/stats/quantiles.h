// The k-th smallest of numbers, their median, and quantiles between order statistics.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace crescent::inline stats {

/// The k-th smallest of these numbers, k from 0; there are more than k.
inline double order_statistic(std::vector<double> v, std::size_t k) {
    const auto at = v.begin() + static_cast<std::ptrdiff_t>(k);
    std::nth_element(v.begin(), at, v.end());
    return *at;
}

/// The middle one, the upper of the two where they are even in number; 0 of none.
inline double median_of(std::vector<double> v) {
    const std::size_t middle = v.size() / 2;
    return v.empty() ? 0 : order_statistic(std::move(v), middle);
}

/// Quantile q of values by linear interpolation between order statistics (R type 7); NaN where one of them is.
double quantile(std::vector<double> values, double q);

}  // namespace crescent::inline stats
