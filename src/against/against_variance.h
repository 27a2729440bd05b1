// Which of two samplers of one f varies less.
#pragma once

#include <span>

#include "verdicts/verdict_kind.h"

namespace crescent::inline against {

/// Which of two samplers of one f has the smaller variance; see against_variance.cpp.
Verdict ratio_of_variances(TrialContext& a, TrialContext& b, const Verdict& of_f);
/// What a sampler whose variance is ranked must pass by itself.
std::span<const VerdictKind* const> judged_alone();

}  // namespace crescent::inline against
