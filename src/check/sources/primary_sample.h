// The random numbers for samplers under test: drawn, or given. Multiples of 2^-24 if a sampler may compute in
// single precision.
#pragma once

#include "check/sources/sampler_adapter.h"

namespace crescent::inline sources {

/// Sample i of a stream: pairs of numbers from pcg4d, as the estimator draws them. `technique` selects the block of
/// dimensions.
PrimarySample drawn_numbers(
    std::uint32_t seed, std::uint32_t pixel, std::uint64_t i, std::uint32_t technique, int count);
/// "u = (0, 0.5)".
std::string describe(const PrimarySample& u, int count, int digits = 9);

}  // namespace crescent::inline sources
