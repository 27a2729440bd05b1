// What the HTML page draws of one w_o: draws by bin beside what p expects, the weights, and p over f L cos in the plane
// of incidence.
#pragma once

#include <span>

#include "check/decide/tail.h"
#include "check/verdict.h"

namespace crescent::check {

/// Draws of one technique by bins of theta and phi about n, from the leaves of its tree: finer where most draws are.
/// Both sides count h = q / (p + q), in draws. Without a density what the draws imply, in 1/sr. None if nothing was
/// drawn.
std::optional<BinHistogram> bin_map(const CheckCase& check_case, const CheckAt& c);
/// Histogram of the weights with the fitted tail. x: of all techniques together.
WeightHistogram weight_picture(const CheckCase& check_case, std::span<const double> x, const WeightTail& tail);
/// Adds p and f L cos along the plane of incidence, which costs evaluations of both at 179 directions.
void add_rose(const CheckCase& check_case, WeightHistogram& to);

}  // namespace crescent::check
