// Contrasts of the draws of a trial with what its bins expect, of one degree of freedom each.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "trials/densities.h"

namespace crescent::inline trials {

/// Means over the draws against their integrals, each as a standard normal deviate with the quadrature's doubt taken
/// off: of log p, of the share of p nearer to the axis, and of cosine and sine of the azimuth about it.
inline constexpr std::size_t contrast_count = 4;
using Contrasts = std::array<double, contrast_count>;
Contrasts contrasts_of(const Densities& work, const Density& bins, const SampleBatch& draws);

/// Of one trial, what the pooled test starts from; densities by technique, for fresh draws to be held against.
struct Contrasted {
    std::vector<Density> densities;
    std::vector<Contrasts> z;  // of the screening draws
};
/// None where p is not known well enough, or no draws can be asked for.
std::optional<Contrasted> contrasted(const Densities& work);

}  // namespace crescent::inline trials
