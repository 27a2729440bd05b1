// Tests of each pixel over renders, with the false discovery rate controlled.
#pragma once

#include "compare/compare.h"
#include "compare/outputs.h"

namespace crescent::inline comparison {

/// Sets the pixel results of `out` and returns p of "no pixel differs"; `sides` are of the same renders, one entry per
/// quantity. Sets nothing and returns NaN if the reference is one file that does not state its error at each pixel.
double test_pixels(std::span<const BiasPair> sides, const BiasLevel& level, BiasResult& out);

/// Returns the level that test_pixels() passes to BiasPair::missable_difference().
double pixel_level(const BiasPair& sides, double alpha);

}  // namespace crescent::inline comparison
