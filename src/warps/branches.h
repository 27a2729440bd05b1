// Which random number chooses among continuous branches of the warp.
#pragma once

#include <span>
#include <vector>

#include "trials/trial_context.h"

namespace crescent::inline warps {

/// How much of the choosing number leads from each of these u to the same direction; 0: not known, because the
/// direction follows that number without a jump or several numbers choose. See branches.cpp.
struct Branches {
    std::vector<double> share;
    double known_to = 0;
    int choosers = 0, chooser = -1;  // chooser: the number that chooses, where it is the only one
};
/// Whether the third number and on choose between continuous branches.
Branches follow_branches(const TrialContext& work, int technique, std::span<const Numbers> at);

}  // namespace crescent::inline warps
