// The estimator as one would first write it: what the kernels are measured against.
#pragma once

#include <string>

#include "crescent/crescent.h"

namespace crescent::bench {

/// Mean luminance of the whole frame, n samples a geometry pixel, rows shared out over `threads`.
double straightforward(const Scene& scene, const std::string& sampler, int n, std::uint32_t seed, int threads);

}  // namespace crescent::bench
