// The random numbers with which a fault is looked for, so that a script can draw them again.
#pragma once

#include <functional>
#include <random>

#include "crescent/crescent.h"

namespace crescent::cli {

using RandomBits = std::mt19937_64;
inline constexpr double below_one = 1 - 0x1p-24;  // the largest number of single precision

/// In [0, 1), of 53 bits.
double uniform(RandomBits& random);
/// Random numbers of one draw, of 24 bits each.
PrimarySample random_numbers(RandomBits& random, int count);
/// `u` with the fewest digits for which the draw at w_o has the property. count: of the numbers that are rounded.
PrimarySample with_few_digits(const SamplerAdapter& sampler, Vec3d wo, const PrimarySample& u, int count,
    const std::function<bool(const Draw&)>& holds);

}  // namespace crescent::cli
