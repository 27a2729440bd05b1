// Samplers whose draws come with a random weight W that estimates 1/p, such as reservoirs: E[h(X) W] is the integral of
// h over the support of their target function.
#pragma once

#include <memory>

#include "check/sources/check_case.h"

namespace crescent {

/// A sampler with Traits::reciprocal_weight, whose weights are W and whose f is the target, as one whose weights are
/// h W and whose f is h = target / (target + q), which is bounded; q: the median of the target over draws at that w_o.
/// Bitterli et al. 2020, "Spatiotemporal reservoir resampling", eq. (6); Lin et al. 2022, "Generalized resampled
/// importance sampling", section 3.
std::shared_ptr<const SamplerAdapter> with_bounded_weights(std::shared_ptr<const SamplerAdapter> sampler);

}  // namespace crescent
