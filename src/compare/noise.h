// Pairs of renders of two arms that share their random numbers, and what the pictures of their differences say.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "compare/plan.h"
#include "compare/renders.h"
#include "experiment/experiment.h"

namespace crescent::inline comparison {

// ---- Renders of two sides that were made with the same random numbers: their residuals, each about the mean of its
// own side, are correlated. Such renders are best compared in pairs.

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
/// of the largest correlation. Empty where some side has one render, or its single renders
/// are not known (moments).
std::vector<SeedPair> shared_seeds(const RenderStats& all, const ArmStats& a, const ArmStats& b);

// ---- The spectrum of an error image: Celarek, Jakob, Wimmer & Lehtinen 2019, "Quantifying the Error of Light
// Transport Algorithms", Computer Graphics Forum 38(4): power of the discrete Fourier transform of Y's error, averaged
// over renders, blocks and directions. White noise has the same power at every frequency.

inline constexpr int spectrum_block = 32;                 // pixels a side of a block
inline constexpr int spectrum_bins = spectrum_block / 2;  // frequencies 1..16 cycles a block; the mean is left out

inline constexpr int spectrum_blocks_most = 1024;  // of a box, by default; of more, every second, third, ... is taken

/// Adds the radial power of `error(i, j)` over whole blocks of the box to `power` (spectrum_bins values). The box must
/// hold a block; smaller ones add nothing. Error units squared.
void add_spectrum(std::vector<double>& power, const Box& box, const std::function<double(int, int)>& error,
    int most_blocks = spectrum_blocks_most);

/// What the noise is like, from the share of power below and above half the Nyquist frequency beside that of white
/// noise.
enum class NoiseColour { unknown, white, blue, correlated };
NoiseColour noise_colour(const std::vector<double>& power);
const char* to_string(NoiseColour colour);

/// Pairs of renders of two arms with the same number in their names: indices into their files. Throws InputError where
/// a render has no partner.
std::vector<RenderPair> pairs_of(const ArmStats& a, const ArmStats& b);

/// Whether each render of either arm is in one of the pairs.
bool all_paired(const std::vector<SeedPair>& shared, const ArmStats& a, const ArmStats& b);

/// Whether a test of pairs, three or more, at this level sees a smaller difference than one of all renders as if they
/// were independent: pairs have less variance, and half the degrees of freedom or fewer.
bool sharper_in_pairs(const std::vector<SeedPair>& shared, const ArmStats& a, const ArmStats& b, double level);

/// Reads both renders of each pair twice; b = arms.size() is the reference.
PairedRenders paired_renders(const ComparePlan& plan, const RenderStats& all, std::size_t a, std::size_t b,
    std::vector<RenderPair> pairs, ProgressMonitor& monitor);

}  // namespace crescent::inline comparison
