// The middle one of numbers in order, the upper of the two where they are even in number; 0 of none.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace crescent::inline verdicts {

inline double median_of(std::vector<double> v) {
    if (v.empty()) return 0;
    const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    return *middle;
}

}  // namespace crescent::inline verdicts
