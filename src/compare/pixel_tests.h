// Welch's test of every pixel over renders, with the false-discovery rate controlled.
#pragma once

#include "compare/sides.h"

namespace crescent::inline comparing {

/// p of one pixel; NaN where it has no noise and no difference, or its noise is not known. 1 where rare events that no
/// render met could make up the difference (`level`, see Sides::unseen).
double pixel_p(const Sides& sides, std::size_t pixel, double level);

/// Fills what the result says of pixels. Nothing where the reference is one file that does not tell its error a pixel.
void test_pixels(const Sides& sides, double alpha, BiasResult& out);

/// The level of Sides::unseen that test_pixels takes.
double pixel_level(const Sides& sides, double alpha);

}  // namespace crescent::inline comparing
