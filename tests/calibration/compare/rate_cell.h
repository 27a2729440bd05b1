// A rate in a cell of tests/calibration/results: "3 of 100 (0.00623–0.0852)", with the 95 % interval of the rate.
#pragma once

#include <cstdint>
#include <fmt/format.h>
#include <string>

#include "math/statistics.h"

namespace crescent {

inline std::string rate_cell(std::uint64_t hits, std::uint64_t of) {
    const auto [low, high] = rate_interval(hits, of);
    return fmt::format("{} of {} ({:.3g}–{:.3g})", hits, of, low, high);
}

}  // namespace crescent
