// A straightforward version of the estimator, with which the kernels are compared.
#pragma once

#include <string>

#include "crescent/crescent.h"

namespace crescent::bench {

/// Returns the mean luminance of the whole frame, n samples per geometry pixel, rows distributed over `threads`.
double straightforward(const Scene& scene, const std::string& sampler, int n, std::uint32_t seed, int threads);

}  // namespace crescent::bench
