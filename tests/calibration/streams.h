// Random numbers of calibration cases: one stream for each key (set, seed, index, purpose). The key is hashed, so that
// neighbouring keys share no numbers.
#pragma once

#include <cstdint>
#include <string_view>

#include "tests/known_samplers/correct/right.h"

namespace crescent::calibration {

/// A case, and the purpose of its numbers.
struct StreamKey {
    std::string_view set;
    std::uint64_t seed = 1, index = 0;
    std::string_view purpose;
};

/// xxHash (XXH3, 64 bits) of all four parts.
std::uint64_t hash_of(const StreamKey& key);
/// Seeded with the whole hash: the seeding of the Mersenne twister distributes it over its 19,968 bits of state.
Rng rng_of(const StreamKey& key);

}  // namespace crescent::calibration
