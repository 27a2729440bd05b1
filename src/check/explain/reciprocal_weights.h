// Causes for random weights W that estimate 1/p.
#pragma once

#include <optional>
#include <span>

#include "check/decide/check_sampler.h"
#include "check/explain/causes.h"
#include "check/sources/check_case.h"

namespace crescent::check {

/// A constant or a factor by which random weights W that estimate 1/p are off.
std::optional<Cause> reciprocal_weight_cause(std::span<const CheckCase> check_cases, const CheckOutcome& outcome);

}  // namespace crescent::check
