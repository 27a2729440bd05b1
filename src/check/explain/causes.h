// The cause of a wrong verdict: candidate causes, each a rule for any sampler, and the one that the evidence supports.
// Factors come from one regression over the leaves of all w_o; frames, rotations and leaks from likelihoods; lobes from
// the draws of each. A cause is named only if the sampler, corrected for it, passes the failed tests, and no other
// candidate does as well; otherwise no cause is named.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "check/decide/check_sampler.h"
#include "check/sources/check_case.h"

namespace crescent::check {

struct Cause {
    std::string factor;              // a name of the list: "constant", "cos theta_i"
    double exponent = 0, error = 0;  // draws / pdf ~ factor^exponent; for a constant its value
    std::string text;                // a sentence
    std::string verdict{};           // the explained verdict; "": the first wrong one of density and normalised
};

/// The cause; none if no cause is named.
std::optional<Cause> cause_of(std::span<const CheckCase> check_cases, const CheckOutcome& outcome);

}  // namespace crescent::check
