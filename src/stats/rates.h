// How often something happened, with its interval.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace crescent::inline stats {

/// Clopper & Pearson 1934: the 95 % interval of a rate.
std::pair<double, double> rate_interval(std::uint64_t hits, std::uint64_t of);
/// "3 of 1000 = 0.003 (95 %: 0.000619 to 0.00874)".
std::string rate_text(std::uint64_t hits, std::uint64_t of);

}  // namespace crescent::inline stats
