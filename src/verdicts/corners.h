// What comes back where u is at the ends of its range.
#pragma once

#include <cstddef>
#include <string>

#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// Faults at corners of u, and how often a generator of 24 bits comes upon such a u.
struct CornerFaults {
    std::string first;
    std::size_t count = 0, tried = 0;
    double chance = 0;  // of one sample
};
/// What comes back at the corners of u.
CornerFaults corner_faults(const TrialContext& work, int technique);

}  // namespace crescent::inline verdicts
