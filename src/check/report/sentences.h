// What a finding says: what was found, how large with its 95 % interval, where.
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
/// What a right verdict measured; "" of one that says it elsewhere.
std::string sentence_of_right(const CheckAt& at, std::string_view verdict);

// ---- What could not be asked of a sampler at one w_o, and why: no pdf(w), no weights, answers that are random
// estimates, a file of draws.

/// Completes a verdict of which nothing is wrong.
void note_limits(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v);

// ---- The density that the draws of a sampler without pdf(w) imply: their share in a cell over its solid angle, with
// its standard error.

/// Into the verdict on the density: by cells of the tree, by rings about n, and where it is highest.
void note_implied_density(const CheckAt& c, Verdict& v);

// ---- Results of a check as verdicts: today's names and states, a sentence each, and the numbers behind it. Nothing
// reads them back.

/// The verdicts of one sampler, for each of its w_o in the order of the list of verdicts.
std::vector<Verdict> verdicts_of(
    std::span<const CheckCase> check_cases, const CheckOutcome& outcome, const std::optional<Cause>& cause);

}  // namespace crescent::check
