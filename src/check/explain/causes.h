// What explains a sampler that is wrong: candidate causes, each a rule for any sampler, and the one that the evidence
// singles out. Factors come from one regression over the leaves of all w_o; frames, turns and leaks from likelihoods;
// lobes from the draws of each. A cause is named only if the sampler that is corrected for it passes the questions that
// it failed, and no other candidate does as well; else none is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/decide/check_sampler.h"

namespace crescent::check {

struct Cause {
    std::string factor;              // a name of the list: "constant", "cos theta_i"
    double exponent = 0, error = 0;  // draws / pdf ~ factor^exponent; of a constant its value
    std::string text;                // a sentence
    std::string verdict{};           // that it explains; "": the first wrong one of density and normalised
};

/// None where nothing is named.
std::optional<Cause> cause_of(std::span<const CheckCase> check_cases, const CheckOutcome& outcome);

}  // namespace crescent::check
