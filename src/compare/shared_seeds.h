// Renders of two sides that were made with the same random numbers: their residuals, each about the mean of its own
// side, are correlated. Such renders are best compared in pairs.
#pragma once

#include <optional>
#include <vector>

#include "compare/renders.h"

namespace crescent::inline comparison {

/// Pixels that are looked at, in square blocks of the image.
struct SeedSamples {
    std::vector<std::uint32_t> pixels;  // those of one block after those of another
    std::vector<std::size_t> ends;      // of each block in `pixels`
};
SeedSamples seed_samples(const RenderStats& all);

/// Residuals of one render at those pixels over their standard deviation; 0 where there is none.
std::vector<float> residuals(const std::vector<float>& y, const MeanFilm& film, const SeedSamples& at);

/// A render of each side, by their places, and the correlation of their noise.
struct SeedPair {
    std::size_t a = 0, b = 0;
    double correlation = 0;
};

/// The probability that independent renders of two sides are taken to share a seed.
inline constexpr double shared_seed_level = 1e-3;

/// Renders of the two sides with correlated residuals, by the t-test over blocks of the mean product of residuals at
/// shared_seed_level over all pairs of renders; of these the pairs of which each has no other partner and at least half
/// of the largest correlation. Empty where some side has one render.
std::vector<SeedPair> shared_seeds(const RenderStats& all, const ArmStats& a, const ArmStats& b);

}  // namespace crescent::inline comparison
