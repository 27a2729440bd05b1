// Quantities of a check, looked up in what a run measured, and the verdict on every assertion of an experiment.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "experiment/assertion.h"
#include "experiment/experiment.h"
#include "metrics/metrics.h"

namespace crescent::inline metrics {

/// Bytes of every plate that was drawn, by its name.
using PlateBytes = std::map<std::string, std::size_t>;

/// The value of a quantity at `seed`, in the unit of its metric; NaN where it was not measured. A plate that is not in
/// `plate_bytes` has 0 bytes.
double quantity(const ParsedQuantity& q, const Metrics& metrics, const Experiment& experiment, std::uint32_t seed,
    const PlateBytes& plate_bytes);

/// One result for each assertion, in the experiment's order. over = "median" compares the median of each side over all
/// seeds of the series (an even count: the mean of the middle two). A NaN on either side, at any of these seeds, fails.
/// An assertion is skipped where it needs what this run does not have: a seed that it is read at (all of the series for
/// a median, the experiment's own else; none where neither side is read off a film), or, with `drawn` = false, a plate.
std::vector<AssertionResult> evaluate_assertions(
    const Experiment& experiment, const Metrics& metrics, const PlateBytes& plate_bytes, bool drawn = true);

}  // namespace crescent::inline metrics
