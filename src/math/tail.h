// The tail index: the generalised Pareto shape k of the largest samples. The variance is infinite from k = 1/2 on, the
// mean from k = 1 on. Zhang & Stephens 2009, "A New and Efficient Estimation Method for the Generalized Pareto
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
    std::uint64_t exceedances = 0;  // number of the largest samples that were fitted
    bool heavy() const { return k >= 0.5; }
};

/// Returns how many of n samples count as tail: min(n/5, 3 sqrt(n)); 0 if that is below 5.
std::size_t tail_length(std::uint64_t n);

/// Returns k and its standard error, (1 + k)/sqrt(M) or for k < -1/2 -k/sqrt(M), from the M + 1 largest samples in
/// descending order: the last of them is the threshold. Empty if there are fewer than 6 or if they do not vary.
std::optional<Tail> fit_tail(std::span<const float> largest);
std::optional<Tail> fit_tail(std::span<const double> largest);

/// The same for samples of many pixels at once, of which a few in a thousand meet a light: the usual threshold may lie
/// among the rest, and the step up to the lit ones would look like a tail. A second fit uses an eighth of the
/// exceedances; if the two differ by more than two standard errors, the second one counts.
std::optional<Tail> fit_pooled_tail(std::span<const float> largest);

}  // namespace crescent::inline statistics
