// Quantities of a check, looked up in what a run measured, and the verdict on every assertion of an experiment.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "experiment/quantity_text.h"
#include "meters/metrics.h"

namespace crescent {

/// The value of a quantity at `seed`, in the unit of its meter; NaN where it was not measured. `plate_bytes` holds the
/// size of every plate that was written; a plate that was not has 0 bytes.
double quantity(const ParsedQuantity& q, const Metrics& metrics, const Experiment& experiment, std::uint32_t seed,
    const std::map<std::string, std::size_t>& plate_bytes);

/// One result for each assertion, in the experiment's order. over = "median" compares the median of each side over all
/// seeds that were run (an even count: the mean of the middle two). A NaN on either side, at any of these seeds, fails.
std::vector<AssertionResult> judge(
    const Experiment& experiment, const Metrics& metrics, const std::map<std::string, std::size_t>& plate_bytes);

}  // namespace crescent
