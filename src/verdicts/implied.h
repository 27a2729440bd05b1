// The density that draws imply.
#pragma once

#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// What the draws of a sampler without pdf(w) imply of its density, as a map and a table; see implied.cpp.
Verdict implied_density(TrialContext& work, Verdict v);

}  // namespace crescent::inline verdicts
