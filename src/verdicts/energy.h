// Whether f gives back more than arrives.
#pragma once

#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// More than there is, granted what eta^2 may do to what comes through; says so. See energy.cpp.
bool creates_energy(const TrialContext& work, const Integral& albedo, Verdict& v);

}  // namespace crescent::inline verdicts
