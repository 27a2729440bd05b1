// What could not be asked of a sampler at one w_o, and why: no pdf(w), no weights, answers that are random estimates, a
// file of draws.
#pragma once

#include "check/decide/check_at.h"
#include "check/verdict.h"

namespace crescent::check {

/// Completes a verdict of which nothing is wrong.
void note_limits(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v);

}  // namespace crescent::check
