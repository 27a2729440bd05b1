// The effect of the resolution of random numbers on the draws.
#pragma once

#include "check/estimate/observations.h"
#include "check/estimate/plan.h"
#include "check/estimate/source.h"
#include "check/verdicts/questions.h"

namespace crescent::check {

/// The share of the draws that a step of 2^-24 of one of their numbers moves to another place, and what that changes in
/// the whole sums. All 0 for a sampler that asks for finer numbers.
struct ResolutionEffect {
    double share = 0;
    Values sums{};
};
ResolutionEffect resolution_effect(Source& source, const Plan& plan, StreamKey key);
/// Whether the resolution may cause a deviation of the density, of so many draws.
bool explains(const ResolutionEffect& effect, const Answer& answer, double draws);

}  // namespace crescent::check
