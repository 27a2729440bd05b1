// What is drawn, by the Jacobian of the warp, held against p.
#pragma once

#include <string>

#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// What p |Jacobian of the warp| says of all techniques.
struct WarpSummary {
    double one_to_one = 1;  // the least share of points at which it is 1
    int choosers = 0;       // the most numbers that choose
};
/// It accuses a technique, which it says, or is added to the summary; and what the summary says of a sampler that none
/// accuses. See warp.cpp.
bool warp_is_wrong(const TrialContext& work, int technique, WarpSummary& all, Verdict& v);
std::string told_of_warp(const TrialContext& work, const WarpSummary& warps);

}  // namespace crescent::inline verdicts
