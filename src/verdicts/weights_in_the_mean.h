// Weights that are right in the mean alone.
#pragma once

#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// Whether weights that are estimates, or are told beside estimates, are off in the mean; says so. See
/// weights_in_the_mean.cpp.
bool weights_are_off(const TrialContext& work, int technique, Verdict& v);

}  // namespace crescent::inline verdicts
