// How heavy is the tail? The generalised Pareto shape k of the largest samples: the variance is infinite from k = 1/2
// on, the mean from k = 1 on. Zhang & Stephens 2009, "A New and Efficient Estimation Method for the Generalized Pareto
// Distribution", Technometrics 51(3), with the threshold and the weak prior of Vehtari et al. 2024, "Pareto Smoothed
// Importance Sampling", JMLR 25.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace crescent::inline statistics {

/// Pareto tail of a set of samples. Zhang & Stephens 2009; k >= 0.5: the variance is infinite, k >= 1: the mean.
struct Tail {
    double k = 0, se = 0;           // estimate and its standard error
    std::uint64_t exceedances = 0;  // how many of the largest samples it was fitted to
    bool heavy() const { return k >= 0.5; }
};

/// How many of n samples count as tail: min(n/5, 3 sqrt(n)); 0 where fewer than 5 would.
std::size_t tail_length(std::uint64_t n);

/// k and its standard error, (1 + k)/sqrt(M) or for k < -1/2 -k/sqrt(M), from the M + 1 largest samples in falling
/// order: the last of them is the threshold. Nothing where they are fewer than 6 or do not spread (every sample alike:
/// no tail to speak of).
std::optional<Tail> fit_tail(std::span<const float> largest);
std::optional<Tail> fit_tail(std::span<const double> largest);

/// The same for samples of many pixels at once, of which a few in a thousand meet a light: the customary threshold may
/// lie among the rest, and the step up to the lit ones would pass for a tail. A second fit to an eighth of the
/// exceedances looks past it; where the two disagree by more than two standard errors, the deeper one counts.
std::optional<Tail> fit_pooled_tail(std::span<const float> largest);

}  // namespace crescent::inline statistics
