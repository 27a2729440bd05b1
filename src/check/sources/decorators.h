// Samplers whose queries are limited, cached or named by another one.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "check/sources/check_case.h"
#include "samplers/sampler_adapter.h"

namespace crescent {

/// Throws SamplerTimeout for a query that would raise the answers of `sampler` above `limit`.
std::shared_ptr<const SamplerAdapter> limited_in_number(
    std::shared_ptr<const SamplerAdapter> sampler, std::uint64_t limit);

/// `sampler` with another name.
std::shared_ptr<const SamplerAdapter> renamed(std::shared_ptr<const SamplerAdapter> sampler, const std::string& name);

/// Throws SamplerTimeout for a call that begins more than `seconds` after this object was made. Until then it changes
/// nothing: results do not depend on the clock unless the limit is reached.
std::shared_ptr<const SamplerAdapter> limited_in_time(std::shared_ptr<const SamplerAdapter> sampler, double seconds);

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
    std::shared_ptr<const SamplerAdapter> sampler_, cache_;
    std::array<double, 3> wo_{};
    std::uint32_t stream_ = 0;
};

/// `sampler`, whose errors begin with `side`, such as "A", and its name, unless they already name a side. A recorded
/// sampler, or one that cannot fail, is returned unchanged.
std::shared_ptr<const SamplerAdapter> named_side(
    std::shared_ptr<const SamplerAdapter> sampler, const std::string& side);

}  // namespace crescent
