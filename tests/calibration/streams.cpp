// The parts are separated by their lengths, so that ("a", "bc") and ("ab", "c") differ.
#include "tests/calibration/streams.h"

#include <string>
#include <xxhash.h>

namespace crescent::calibration {

std::uint64_t hash_of(const StreamKey& key) {
    std::string bytes;
    const auto number = [&](std::uint64_t v) { bytes.append(reinterpret_cast<const char*>(&v), sizeof v); };
    for (const std::string_view part : {key.set, key.purpose}) {
        number(part.size());
        bytes.append(part);
    }
    number(key.seed);
    number(key.index);
    return XXH3_64bits(bytes.data(), bytes.size());
}

Rng rng_of(const StreamKey& key) { return Rng(hash_of(key)); }

}  // namespace crescent::calibration
