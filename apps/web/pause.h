// Work that cannot be cut into parts pauses in the middle: wasm-opt's pass asyncify lets a call leave the module at any
// depth and return there. A pause does not change the results.
#pragma once

#include <cstdint>
#include <memory>

#include "crescent/portable.h"

namespace crescent::web {

/// Returns `sampler`, queried in blocks of at most one part's work (parts.h); it pauses before a block that exceeds the
/// rest of the part.
std::shared_ptr<const SamplerAdapter> paused(std::shared_ptr<const SamplerAdapter> sampler);

/// Call before work of this cost (parts.h): pauses if it exceeds the rest of the part.
void make_room(std::uint64_t cost);

}  // namespace crescent::web
