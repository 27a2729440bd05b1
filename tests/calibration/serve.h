// A calibration sampler as a program behind a pipe: protocol 2 of `crescent check --exec`, by blocks.
#pragma once

#include <cstdio>

#include "tests/calibration/sampler.h"

namespace crescent::calibration {

/// Answers on `out` until `in` ends; false if a request cannot be read.
bool serve(const Sampler& sampler, std::FILE* in, std::FILE* out);

}  // namespace crescent::calibration
