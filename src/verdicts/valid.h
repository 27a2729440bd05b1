// What of a batch of draws cannot be used.
#pragma once

#include <string>

#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// What is wrong with the first of these draws that cannot be used, "" where all can.
std::string first_fault(const TrialContext& work, int technique, const SampleBatch& b);

}  // namespace crescent::inline verdicts
