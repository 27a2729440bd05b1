// normalised and density, by sums over all draws: mass (h = 1), bridge, slope, centre.
#pragma once

#include <array>
#include <optional>

#include "check/estimate/plan.h"
#include "check/verdicts/questions.h"

namespace crescent::check {

/// Calls `visit` for every member of its families.
void test_sums(const Evidence& e, const Visit& visit);

/// A whole sum on both sides, by independent draws or by replicates.
struct SumComparison {
    double difference = 0, floor = 0;
    double drawn_variance = 0, claim_variance = 0;
    double freedom = 0;  // degrees of freedom of the sum of both
    double largest = 0;  // largest single term, for Bennett's inequality; 0: Student's t
    double visible = 1;  // part of a difference between two samplers that the right side, the mean of both, shows
    double variance() const { return drawn_variance + claim_variance; }
    double p() const;
};
/// A whole sum by both kinds of draws.
struct WholeSum {
    SumComparison by_draws;
    std::optional<SumComparison> by_sets;  // none without replicates, and for the mass if every draw is a direction
};
std::array<WholeSum, integrands> compare_sums(const Evidence& e);

}  // namespace crescent::check
