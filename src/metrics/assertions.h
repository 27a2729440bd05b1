// Looks up the quantities of an assertion in the measurements of a run, and evaluates every assertion of an
// experiment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "experiment/assertion.h"
#include "experiment/experiment.h"
#include "metrics/metrics.h"

namespace crescent {

/// Bytes of every plate that was drawn, by its name.
using PlateBytes = std::map<std::string, std::size_t>;

/// Returns the value of a quantity at `seed`, in the unit of its metric; NaN if it was not measured. A plate that is
/// not in `plate_bytes` has 0 bytes.
double quantity(const ParsedQuantity& q, const Metrics& metrics, const Experiment& experiment, std::uint32_t seed,
    const PlateBytes& plate_bytes);

/// Returns one result for each assertion, in the experiment's order. over = "median" compares the median of each side
/// over all seeds of the series (for an even count, the mean of the middle two). A NaN on either side, at any of these
/// seeds, fails. An assertion is skipped if it needs what this run does not have: a seed (all of the series for a
/// median, else the experiment's own; none if neither side is read from a film), a tail or furnace without studies, or,
/// with `has_plates` = false, a plate.
std::vector<AssertionResult> evaluate_assertions(
    const Experiment& experiment, const Metrics& metrics, const PlateBytes& plate_bytes, bool has_plates = true);

}  // namespace crescent
