// A number that is warped wrongly, as the derivatives of sample(u) show without noise.
#pragma once

#include <optional>
#include <span>

#include "check/explain/causes.h"
#include "check/explain/hypothesis.h"

namespace crescent::check {

/// A power of a random number is missing or once too often in sample: a root.
std::optional<Cause> warp_cause(std::span<const Place> places);

}  // namespace crescent::check
