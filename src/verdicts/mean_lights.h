// Weights under lights from one side.
#pragma once

#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// Weights without a pdf whose mean under a light from one side is not the integral; says so. See mean_lights.cpp.
bool directions_are_off(const TrialContext& work, Verdict& v);

}  // namespace crescent::inline verdicts
