// The spectrum of an error image: Celarek, Jakob, Wimmer & Lehtinen 2019, "Quantifying the Error of Light Transport
// Algorithms", Computer Graphics Forum 38(4): power of the discrete Fourier transform of Y's error, averaged over
// renders, blocks and directions. White noise has the same power at every frequency.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "experiment/experiment.h"

namespace crescent::inline comparison {

inline constexpr int spectrum_block = 32;                 // pixels a side of a block
inline constexpr int spectrum_bins = spectrum_block / 2;  // frequencies 1..16 cycles a block; the mean is left out

inline constexpr int spectrum_blocks_most = 1024;  // of a box; of more, every second, third, ... is taken

/// Adds the radial power of `error(i, j)` over whole blocks of the box to `power` (spectrum_bins values). The box must
/// hold a block; smaller ones add nothing. Error units squared.
void add_spectrum(std::vector<double>& power, const Box& box, const std::function<double(int, int)>& error);

/// What the noise is like, from the share of power below and above half the Nyquist frequency beside that of white
/// noise.
enum class NoiseColour { unknown, white, blue, correlated };
NoiseColour noise_colour(const std::vector<double>& power);
const char* to_string(NoiseColour colour);

}  // namespace crescent::inline comparison
