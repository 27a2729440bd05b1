// Adapters around a sampler: answers at a pair of directions are cached for one check, and a side gets its own label.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "check/sources/sampler_adapter.h"

namespace crescent::inline sources {

// ---- A sampler that is asked for the same thing once: what p and f are at a pair of directions is kept as long as a
// case lasts. Integrals of one case start from the same cells, so that a sampler answers for their nodes a single
// time.

/// `sampler`, with its answers for quadrature and for f kept, and those that it gives counted; for one thread. draws:
/// those for the same u, and pdf(w) at them, are kept too.
std::shared_ptr<const SamplerAdapter> cached(std::shared_ptr<const SamplerAdapter> sampler, bool draws = false);
/// What answers anew, whatever was kept.
const SamplerAdapter& uncached(const SamplerAdapter& sampler);

/// One side of a comparison and the stream that it draws from.
struct Side {
    CheckCase check_case;
    std::uint32_t stream = 0;
};

/// A program is asked once at each w_o: its answers and its draws there serve every case that has this w_o, whatever
/// the surface and the light of the other side are. CheckCases of one w_o come one after the other.
class PerDirectionCache {
public:
    Side of(const CheckCase& check_case, std::uint32_t stream);

private:
    std::shared_ptr<const SamplerAdapter> cached_of_, cache_;
    std::array<double, 3> wo_{};
    std::uint32_t stream_ = 0;
};

// ---- Two samplers are asked in turn: what breaks off says which of them it was.

/// `sampler`, whose faults begin with `side`, "A", and its name; a fault that has a side already keeps it. What is
/// recorded, or cannot fail, is given back as it is.
std::shared_ptr<const SamplerAdapter> named_side(
    std::shared_ptr<const SamplerAdapter> sampler, const std::string& side);

}  // namespace crescent::inline sources
