// Where delta parts go, held to the law of refraction.
#pragma once

#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// A delta part goes where neither the index that is told nor a thin wall lets it through; says so. See snell.cpp.
bool refracts_elsewhere(const TrialContext& work, Verdict& v);
/// Where a delta part goes, no delta part comes back from; says so.
bool comes_not_back(const TrialContext& work, Verdict& v);

}  // namespace crescent::inline verdicts
