// Results of a check as verdicts: names and states, sentences, and the numbers of evidence. No code reads the texts of
// the sentences.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "check/decide/check_sampler.h"
#include "check/explain/causes.h"
#include "check/verdict.h"

namespace crescent::check {

/// The verdicts of one sampler, for each of its w_o in the order of the verdict list.
std::vector<Verdict> verdicts_of(
    std::span<const CheckCase> check_cases, const CheckOutcome& outcome, const std::optional<Cause>& cause);

}  // namespace crescent::check
