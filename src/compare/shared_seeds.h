// Renders of two sides with the same random numbers: their residuals, each from the mean of its own side, are
// correlated. Such renders are best compared in pairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compare/renders.h"

namespace crescent {

/// The pixels that are sampled, in square blocks of the image.
struct SeedSamples {
    std::vector<std::uint32_t> pixels;  // block after block
    std::vector<std::size_t> ends;      // of each block in `pixels`
};
SeedSamples seed_samples(const RenderStats& stats);

/// Residuals of one render at those pixels over their standard deviation; 0 where there is none.
std::vector<float> residuals(const std::vector<float>& y, const MeanFilm& film, const SeedSamples& samples);

/// A render of each side, by index, and the correlation of their noise.
struct SeedPair {
    std::size_t a = 0, b = 0;
    double correlation = 0;
};

/// The probability with which independent renders of two sides are taken for renders with a shared seed.
inline constexpr double shared_seed_level = 1e-3;

/// Returns the renders of the two sides with correlated residuals, by the t-test over blocks of the mean product of
/// residuals at shared_seed_level over all pairs of renders; of these, the pairs without another partner and with at
/// least half of the largest correlation. Empty if a side has one render, or if its single renders are unknown
/// (moments).
std::vector<SeedPair> shared_seeds(const RenderStats& stats, const ArmStats& a, const ArmStats& b);

}  // namespace crescent
