// Tests of every pixel over renders, with the false-discovery rate controlled.
#pragma once

#include "compare/compare.h"
#include "compare/outputs.h"

namespace crescent::inline comparison {

/// Fills what the result says of pixels; `sides` are of the same renders, one for each quantity. Nothing where the
/// reference is one file that does not say its error at each pixel.
/// Returns p of "no pixel differs".
double test_pixels(std::span<const BiasPair> sides, const BiasLevel& level, BiasResult& out);

/// The level of BiasPair::unseen that test_pixels takes.
double pixel_level(const BiasPair& sides, double alpha);

}  // namespace crescent::inline comparison
