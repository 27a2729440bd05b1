// The sentence of a finding: what was found, how large with its 95 % interval, and where.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "check/decide/check_at.h"
#include "check/decide/check_sampler.h"
#include "check/explain/causes.h"
#include "check/verdict.h"

namespace crescent::check {

std::string sentence_of(const CheckAt& at, const Finding& finding);
std::string sentence_of(const SmallFault& fault, int numbers);
/// The measurement of a right verdict; "" for a verdict without one.
std::string sentence_of_right(const CheckAt& at, std::string_view verdict);

// ---- Tests that were not possible for a sampler at one w_o, and the reason: no pdf(w), no weights, answers that are
// random estimates, a file of draws.

/// Completes a verdict that has no fault.
void note_limits(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v);

// ---- The density that the draws of a sampler without pdf(w) imply: their share in a cell over its solid angle, with
// its standard error.

/// Adds it to the verdict on the density: by cells of the tree, by rings about n, and at its maximum.
void note_implied_density(const CheckAt& c, Verdict& v);

// ---- Results of a check as verdicts: names and states, a sentence each, and the numbers of evidence. No code reads
// the sentences.

/// The verdicts of one sampler, for each of its w_o in the order of the verdict list.
std::vector<Verdict> verdicts_of(
    std::span<const CheckCase> check_cases, const CheckOutcome& outcome, const std::optional<Cause>& cause);

}  // namespace crescent::check
