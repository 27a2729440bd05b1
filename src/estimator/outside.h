// The kernels of samplers from outside: their draws are made first, in batches, and are then estimated like those of an
// built-in arm. Scalar code on every machine: the time goes into the sampler.
#pragma once

#include "arms/outside.h"
#include "estimator/kernel.h"

namespace crescent::inline estimator {

/// As a kernel of the table. A direction that is not of unit length to 1e-4 makes a bad sample, and so does a pdf that
/// cannot be used: NaN, negative, or in single precision infinite, or 0 though it is not 0 in double.
void estimate_outside(const OutsideSampler& sampler, const KernelCall& call);

}  // namespace crescent::inline estimator
