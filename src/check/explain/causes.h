// What explains a density that is wrong: one regression over the leaves of all w_o on the factors that samplers leave
// out or have twice. A cause is named only if it explains the misfit and is a simple number of a factor; else none is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/decide/check_sampler.h"

namespace crescent::check {

struct Cause {
    std::string factor;              // a name of the list, "constant"
    double exponent = 0, error = 0;  // draws / pdf ~ factor^exponent; of a constant its value
    std::string text;                // a sentence
};

/// None where nothing is named.
std::optional<Cause> cause_of(std::span<const Trial> trials, const CheckOutcome& outcome);

}  // namespace crescent::check
