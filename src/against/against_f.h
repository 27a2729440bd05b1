// Whether two samplers are of one f.
#pragma once

#include "trials/trial_context.h"

namespace crescent::inline against {

/// Whether two samplers are of one f; see against_f.cpp. A difference is told, and is wrong where none is expected.
Verdict same_f(const TrialContext& a, const TrialContext& b, bool expect_same);

}  // namespace crescent::inline against
