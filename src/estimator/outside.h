// The kernels of samplers from outside: their draws are made first, in batches, and are then estimated like those of an
// built-in arm. Scalar code on every machine: the time goes into the sampler.
#pragma once

#include "arms/outside.h"
#include "estimator/kernel.h"

namespace crescent::inline estimator {

/// As a kernel of the table. A direction that is not unit to 1e-4, or a pdf below 0, makes a bad sample.
void estimate_outside(const OutsideSampler& sampler, const KernelCall& call);

}  // namespace crescent::inline estimator
