// Counts of bins held against what is due in each.
#pragma once

#include <cstddef>
#include <vector>

namespace crescent::inline stats {

/// The bin that is off by the most standard deviations.
std::size_t worst_bin(const std::vector<double>& observed, const std::vector<double>& expected);
/// What share of the draws may be too many or too few in one bin and not be seen: what takes the chi-square over all
/// bins to its level, half of the time, in the fullest of them.
double unseen_share(const std::vector<double>& expected, double degrees, double draws, double level);

}  // namespace crescent::inline stats
