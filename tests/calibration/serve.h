// A calibration sampler as a program behind a pipe: the protocol of `crescent check --exec`, with blocks.
#pragma once

#include <cstdio>

#include "tests/calibration/sampler.h"

namespace crescent::calibration {

/// Answers requests on `out` until `in` ends; returns false if a request cannot be read.
bool serve(const Sampler& sampler, std::FILE* in, std::FILE* out);

}  // namespace crescent::calibration
