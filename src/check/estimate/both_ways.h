// The reciprocity of f if no index is stated: f or f |cos| is symmetric, so that no index scales it across the
// surface, or neither is.
#pragma once

#include "check/estimate/stream.h"
#include "samplers/sampler_adapter.h"

namespace crescent::check {

enum class BothWays { not_known, same_f, phase_function };

/// Evaluates f at pairs of directions. A phase function, given as f |cos|, is positive in every direction. For a
/// sampler that takes only w_o above the surface, only pairs above it are exchanged.
BothWays both_ways(const SamplerAdapter& adapter, StreamKey key);

}  // namespace crescent::check
