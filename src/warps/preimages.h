// How often a direction is reached, and from which u.
#pragma once

#include <cstddef>
#include <vector>

#include "trials/trial_context.h"

namespace crescent::inline warps {

/// Directions that several lobes of the sampler reach, each from a u of its own, and what they draw there together; see
/// preimages.cpp.
struct Reached {
    std::size_t looked_at = 0, denser = 0;  // directions; and those drawn more often than p says
    Vec3d worst{};
    double most = 1;  // drawn density over p there
    /// What either of two lobes draws over p where no third was found; `low`: by the lower numbers that choose.
    struct Pair {
        double low, high;
    };
    std::vector<Pair> pairs;
    int chooser = 0;  // the number that chooses; 0: the first leads to both
};
/// Looked at once; kept with the work.
const Reached& preimages_of(const TrialContext& work, int technique);

}  // namespace crescent::inline warps
