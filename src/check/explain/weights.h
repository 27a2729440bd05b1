// Causes for weights, f and densities that are returned with the draws: their ratio to the expected value is known at
// every draw, without noise.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "check/decide/check_sampler.h"
#include "check/explain/causes.h"
#include "check/explain/factors.h"
#include "check/sources/check_case.h"
#include "samplers/traits.h"

namespace crescent::check {

std::optional<Cause> weight_cause(std::span<const CheckCase> check_cases, const CheckOutcome& outcome);

/// "Weights are f cos / p over cos theta_i and a constant 0.5 = 1/2."
std::string ratio_sentence(const char* subject, const char* expected, const RatioCause& cause, const Traits& traits);

}  // namespace crescent::check
