// The tail of the weights X = f L cos / p: the Pareto index k of the largest (PSIS, Vehtari et al. 2024,
// math/statistics.h), and the unseen tail, which is the part of the integral where X is larger than any drawn weight.
// The points of the integrals show the unseen tail; the draws cannot.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "check/constants.h"
#include "check/decide/check_at.h"
#include "check/verdict.h"
#include "math/statistics.h"

namespace crescent::check {

/// Of all techniques together.
struct WeightTail {
    bool has_weights = false;      // whether every draw has a weight
    bool has_lower_draws = false;  // whether some draws are below the surface
    Spread spread;
    double variance_error = 0;      // relative standard error of the variance
    std::optional<Tail> fit;        // none if the largest weights are equal
    std::size_t times_largest = 0;  // number of draws of the largest weight
    bool bounded = false;           // whether the largest weight is at most a few means
    double integral = 0;            // integral of f L cos where p > 0, from the points, including delta parts
    // Regions where weights exceed the largest drawn, summed over the techniques:
    double unseen = 0, unseen_error = 0;  // integral of f L cos, and its standard error
    double unseen_chance = 0;             // integral of p
    double half_chance = 0;               // the same over the largest weights that contribute half of `unseen`

    bool heavy() const { return !bounded && fit && fit->k - 2 * fit->se >= heavy_index; }
    /// Whether the interval of k contains 1/2.
    bool open() const { return !bounded && !heavy() && fit && fit->k + 2 * fit->se >= heavy_index; }
    bool has_unseen() const;
};

/// X of each draw, summed over the techniques of one w_o.
std::vector<double> weights_of(std::span<const CheckAt> techniques);
/// Only the fit, for weights without points.
WeightTail tail_of_weights(std::span<const double> x);
WeightTail tail_of(std::span<const CheckAt> techniques);

/// Sets the verdict `tail`: right, or inconclusive with the next step, or skipped.
void test_tail(const CheckCase& check_case, const WeightTail& t, Verdict& v);
/// Adds the plain mean of the weights to the evidence of `mean`. If the weights have no finite variance the verdict
/// becomes inconclusive: the tests passed, but no interval of the plain mean is valid.
void test_plain_mean(const WeightTail& t, Verdict& v);

}  // namespace crescent::check
