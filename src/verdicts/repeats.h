// What comes again: answers, directions, delta parts.
#pragma once

#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// The same u is answered otherwise, the very direction comes again, or a delta part comes with another weight; says
/// so. See repeats.cpp.
bool answers_otherwise(const TrialContext& work, int technique, Verdict& v);
bool repeats_directions(const TrialContext& work, const SampleBatch& b, Verdict& v);
bool has_uneven_deltas(const TrialContext& work, const SampleBatch& b, Verdict& v);

}  // namespace crescent::inline verdicts
