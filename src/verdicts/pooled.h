// What no w_o shows alone: contrasts of one degree of freedom, pooled over all w_o of a sampler.
#pragma once

#include <array>
#include <optional>

#include "verdicts/trial_context.h"

namespace crescent::inline verdicts {

/// Means over the draws against their integrals, each as a standard normal deviate with the quadrature's doubt taken
/// off: of log p, of the share of p nearer to the axis, and of cosine and sine of the azimuth about it.
inline constexpr std::size_t contrast_count = 4;
using Contrasts = std::array<double, contrast_count>;
Contrasts contrasts_of(const TrialContext& work, const Density& bins, const SampleBatch& draws);

/// Of one trial, what the pooled test starts from; densities by technique, for fresh draws to be held against.
struct Contrasted {
    std::vector<Density> densities;
    std::vector<Contrasts> z;  // of the screening draws
};
/// None where p is not known well enough, or no draws can be asked for.
std::optional<Contrasted> contrasted(const TrialContext& work);

struct Outcome;
/// How many tests that makes: one a contrast and sampler of four w_o or more.
std::uint64_t pooled_tests(std::span<const Trial> trials);
/// Where the contrasts of a sampler's w_o together are off, and again on a fresh seed, density is wrong at the w_o that
/// shows it most.
void judge_pooled(std::span<const Trial> trials, std::span<Outcome> outcomes, const TestSettings& settings,
    TestCounts& test_counts, const ProgressMonitor& monitor);

}  // namespace crescent::inline verdicts
