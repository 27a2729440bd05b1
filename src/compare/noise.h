// Pairs of renders of two arms with shared random numbers, the statistics of their differences, and the spectrum of
// noise.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/shared_seeds.h"
#include "experiment/experiment.h"

namespace crescent {

// ---- The spectrum of an error image: Celarek, Jakob, Wimmer & Lehtinen 2019, "Quantifying the Error of Light
// Transport Algorithms", Computer Graphics Forum 38(4): power of the discrete Fourier transform of Y's error, averaged
// over renders, blocks and directions. White noise has the same power at every frequency.

inline constexpr int spectrum_block = 32;                 // pixels per side of a block
inline constexpr int spectrum_bins = spectrum_block / 2;  // frequencies 1..16 cycles per block, without the mean

inline constexpr int spectrum_blocks_most =
    1024;  // of a box, by default; if it has more, every second, third, ... is used

/// Adds the radial power of `error(i, j)` over whole blocks of the box to `power` (spectrum_bins values), in error
/// units squared. A box without a whole block adds nothing.
void add_spectrum(std::vector<double>& power, const Box& box, const std::function<double(int, int)>& error,
    int most_blocks = spectrum_blocks_most);

/// Classifies noise by its power below and above half the Nyquist frequency, relative to white noise.
enum class NoiseColour { unknown, white, blue, correlated };
NoiseColour noise_colour(const std::vector<double>& power);
const char* to_string(NoiseColour colour);

/// Returns pairs of renders of two arms with the same number in their names, as indices into their files. Throws
/// InputError if a render has no partner.
std::vector<RenderPair> pairs_of(const ArmStats& a, const ArmStats& b);

/// Returns whether each render of both arms is in one of the pairs.
bool all_paired(const std::vector<SeedPair>& shared, const ArmStats& a, const ArmStats& b);

/// Returns whether a test of the pairs, three or more, detects a smaller difference at this level than a test of all
/// renders as independent: pairs have less variance, and at most half the degrees of freedom.
bool sharper_in_pairs(const std::vector<SeedPair>& shared, const ArmStats& a, const ArmStats& b, double level);

/// Reads both renders of each pair twice and returns the statistics of their differences; b = arms.size() is the
/// reference.
PairedRenders paired_renders(const ComparePlan& plan, const RenderStats& stats, std::size_t a, std::size_t b,
    std::vector<RenderPair> pairs, ProgressMonitor& monitor);

}  // namespace crescent
