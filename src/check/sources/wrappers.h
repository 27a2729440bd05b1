// Adapters of a sampler: a cache of answers for one check, and a label for one side of a comparison.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "check/sources/sampler_adapter.h"

namespace crescent::inline sources {

// ---- A cache of p and f at pairs of directions for the duration of a case. Integrals of one case start from the same
// cells, so that each of their points is evaluated once.

/// `sampler` with a cache of its exact densities and f and a counter of its answers; for one thread. draws: also caches
/// draws for the same u, and pdf(w) at them.
std::shared_ptr<const SamplerAdapter> cached(std::shared_ptr<const SamplerAdapter> sampler, bool draws = false);
/// The sampler without its cache.
const SamplerAdapter& uncached(const SamplerAdapter& sampler);

/// One side of a comparison and its random stream.
struct Side {
    CheckCase check_case;
    std::uint32_t stream = 0;
};

/// Queries a program once for each w_o: its answers and draws serve every case with this w_o, independent of the
/// surface and the light of the other side. Cases of one w_o must be consecutive.
class PerDirectionCache {
public:
    Side of(const CheckCase& check_case, std::uint32_t stream);

private:
    std::shared_ptr<const SamplerAdapter> cached_of_, cache_;
    std::array<double, 3> wo_{};
    std::uint32_t stream_ = 0;
};

// ---- Errors in a comparison of two samplers name the failing sampler.

/// `sampler`, whose errors begin with `side`, such as "A", and its name, unless they already name a side. A recorded
/// sampler, or one that cannot fail, is returned unchanged.
std::shared_ptr<const SamplerAdapter> named_side(
    std::shared_ptr<const SamplerAdapter> sampler, const std::string& side);

}  // namespace crescent::inline sources
