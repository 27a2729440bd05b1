// Work that cannot be cut into parts pauses in the middle: wasm-opt's pass asyncify lets a call leave the module from
// wherever it is, and come back there. A pause changes nothing of what is computed.
#pragma once

#include <cstdint>
#include <memory>

#include "crescent/portable.h"

namespace crescent::web {

/// `sampler`, asked in blocks of at most one part's work (parts.h); it pauses before a block that does not fit into
/// what is left of the part.
std::shared_ptr<const SamplerAdapter> paused(std::shared_ptr<const SamplerAdapter> sampler);

/// To be called before work of this cost (parts.h): pauses where it does not fit into what is left of the part.
void make_room(std::uint64_t cost);

}  // namespace crescent::web
