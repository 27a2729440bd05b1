// What explains weights, f and densities that come with the draws: their ratio to what they ought to be is known at
// every draw, without noise.
#pragma once

#include "check/explain/causes.h"
#include "check/explain/ratios.h"

namespace crescent::check {

std::optional<Cause> weight_cause(std::span<const CheckCase> check_cases, const CheckOutcome& outcome);

/// "Weights are f cos / p over cos theta_i and a constant 0.5 = 1/2."
std::string ratio_sentence(const char* given, const char* due, const RatioCause& cause, const Traits& traits);

}  // namespace crescent::check
