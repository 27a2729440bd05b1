// A sampler that is asked for the same thing once: what p and f are at a pair of directions is kept as long as a trial
// lasts. Integrals of one trial start from the same cells, so that a program answers for their nodes a single time.
#pragma once

#include <memory>

#include "verdicts/subject.h"

namespace crescent::inline verdicts {

/// `sampler`, with its answers for quadrature and for f kept; for one thread.
std::shared_ptr<const JudgedSampler> asked_once(std::shared_ptr<const JudgedSampler> sampler);
/// What answers anew, whatever was kept.
const JudgedSampler& afresh(const JudgedSampler& sampler);

}  // namespace crescent::inline verdicts
