// Draws on a curve: the derivatives of sample(u) with respect to all of its numbers are parallel.
#pragma once

#include <optional>

#include "check/decide/small_tests.h"
#include "check/estimate/source.h"

namespace crescent::check {

/// Draws on a curve, which no density draws: at nearly all u no two random numbers move the draw apart, as if one
/// number is used twice.
std::optional<SmallFault> draws_on_curve(Source& source, const StreamKey& key);

}  // namespace crescent::check
