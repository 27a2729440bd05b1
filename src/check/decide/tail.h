// How heavy the weights X = f L cos / p are: the Pareto index k of the largest (PSIS, Vehtari et al. 2024,
// stats/tail.h), and the unseen tail, which is the part of the integral that lies where X is larger than any weight
// drawn. The points of the integrals show it; draws cannot.
#pragma once

#include <optional>
#include <span>

#include "check/decide/check_at.h"
#include "check/verdict.h"
#include "math/statistics.h"

namespace crescent::check {

/// Of all techniques together.
struct WeightTail {
    bool weighed = false;  // every draw has a weight
    bool whole = false;    // some draws go below the surface
    statistics::Spread spread;
    double variance_error = 0;            // relative standard error of the variance
    std::optional<statistics::Tail> fit;  // none where the largest weights do not spread
    std::size_t times_largest = 0;        // draws of the largest weight
    bool bounded = false;                 // the largest weight is no more than a few means
    double due = 0;                       // integral of f L cos where p > 0, by the points; with that of delta parts
    // Where weights are larger than any drawn, by technique summed:
    double unseen = 0, unseen_error = 0;  // integral of f L cos, and its standard error
    double unseen_chance = 0;             // integral of p
    double half_chance = 0;               // the same over the largest weights that carry half of `unseen`

    bool heavy() const { return !bounded && fit && fit->k - 2 * fit->se >= heavy_index; }
    /// The interval of k contains 1/2.
    bool open() const { return !bounded && !heavy() && fit && fit->k + 2 * fit->se >= heavy_index; }
    bool has_unseen() const;
};

/// X of each draw, summed over the techniques of one w_o.
std::vector<double> weights_of(std::span<const CheckAt> techniques);
/// The fit alone, for weights without points.
WeightTail tail_of_weights(std::span<const double> x);
WeightTail tail_of(std::span<const CheckAt> techniques);

/// The verdict `tail`: right, or inconclusive with what would settle it, or skipped.
void test_tail(const CheckCase& check_case, const WeightTail& t, Verdict& v);
/// The plain mean of the weights, into the evidence of `mean`, which stays open where they have no variance: what was
/// tested is right, but no interval of the plain mean means anything.
void test_plain_mean(const WeightTail& t, Verdict& v);

}  // namespace crescent::check
