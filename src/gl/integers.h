// The random integers as the driver computes them.
#pragma once

#include <cstdint>
#include <vector>

#include "context.h"

namespace crescent::gl {

/// The input of a set of hashes: pixels 0 to width x height - 1, one pair of samples, one block of dimensions, one
/// seed.
struct IntegerBlock {
    int width = 0, height = 0;
    std::uint32_t pair = 0, block = 0, seed = 0;
};

/// Returns four integers per pixel, by src/gl/shaders/integers.glsl, for each block.
std::vector<std::vector<std::uint32_t>> driver_integers(
    const Context& context, const std::vector<IntegerBlock>& blocks);
/// Returns how many of them differ from draws() of src/math/simd/random.h.
std::uint64_t unlike_integers(const IntegerBlock& block, const std::vector<std::uint32_t>& integers);

}  // namespace crescent::gl
