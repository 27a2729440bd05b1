// The random numbers for samplers under test, multiples of 2^-24 since a sampler may compute in single precision.
#pragma once

#include <cstdint>
#include <vector>

#include "samplers/traits.h"

namespace crescent {

/// Sample i of a stream: pairs of numbers from pcg4d, as the estimator draws them. `technique` selects the block of
/// dimensions.
PrimarySample drawn_numbers(
    std::uint32_t seed, std::uint32_t pixel, std::uint64_t i, std::uint32_t technique, int count);

/// Draws to which the chart of an infinite line is fitted, and their random numbers, `count` each.
inline constexpr std::uint32_t draws_of_chart = 4096;
std::vector<PrimarySample> numbers_of_chart(int count);

}  // namespace crescent
