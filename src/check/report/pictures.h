// The pictures of the HTML page for one w_o: draws by bin with the expectation of p, the weights, and p and f L cos in
// the plane of incidence.
#pragma once

#include <optional>
#include <span>

#include "check/decide/check_at.h"
#include "check/decide/tail.h"
#include "check/sources/check_case.h"
#include "check/verdict.h"

namespace crescent::check {

/// Draws and expectation over a line or a set; none for another domain.
std::optional<LineHistogram> line_picture(const CheckCase& check_case, const CheckAt& check);
/// Draws of one technique by bins of theta and phi about n, from the leaves of its tree, finer where most draws are.
/// Both sides are sums of h = q / (p + q), in units of draws. Without a density: the density that the draws imply, in
/// 1/sr. None if there are no draws.
std::optional<BinHistogram> bin_map(const CheckCase& check_case, const CheckAt& c);
/// Histogram of the weights with the fitted tail. x: weights of all techniques.
WeightHistogram weight_picture(const CheckCase& check_case, std::span<const double> x, const WeightTail& tail);
/// Adds p and f L cos along the plane of incidence, which costs evaluations of both at 179 directions.
void add_rose(const CheckCase& check_case, WeightHistogram& to);

}  // namespace crescent::check
