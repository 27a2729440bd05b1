// What f is the other way round, where no index is stated: the same as f or as f |cos|, so that none scales it across
// the surface, or neither.
#pragma once

#include "check/estimate/source.h"

namespace crescent::check {

enum class BothWays { not_known, same_f, phase_function };

/// By f at pairs of directions. A phase function, given as f |cos|, is positive in every direction; of a sampler that
/// takes w_o above the surface alone, only pairs above are turned round.
BothWays both_ways(const SamplerAdapter& adapter, StreamKey key);

}  // namespace crescent::check
