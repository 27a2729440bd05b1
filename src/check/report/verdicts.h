// Results of a check as verdicts: today's names and states, a sentence each, and the numbers behind it. Nothing reads
// them back.
#pragma once

#include <span>
#include <vector>

#include "check/decide/check_sampler.h"
#include "check/explain/causes.h"
#include "check/verdict.h"

namespace crescent::check {

/// The verdicts of one sampler, for each of its w_o in the order of the list of verdicts.
std::vector<Verdict> verdicts_of(
    std::span<const CheckCase> check_cases, const CheckOutcome& outcome, const std::optional<Cause>& cause);

}  // namespace crescent::check
