// What cannot be written in parts is paused: wasm-opt's pass asyncify lets a call leave the module from wherever it is,
// and come back there. A pause changes nothing of what is computed.
#pragma once

#include <cstdint>
#include <memory>

#include "core.h"

namespace crescent::web {

/// `sampler`, which is asked in blocks of at most a part's work (parts.h), with a pause before a block for which no
/// room is left in the part.
std::shared_ptr<const JudgedSampler> paused(std::shared_ptr<const JudgedSampler> sampler);

/// Before work of so much cost (parts.h) within a call: pauses where the part has no room left for it.
void make_room(std::uint64_t cost);

}  // namespace crescent::web
