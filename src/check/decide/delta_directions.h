// Directions of delta parts: a smooth boundary reflects, and refracts by the stated index (Snell); a thin wall
// transmits straight; the reverse path returns to w_o with the same power (Helmholtz).
#pragma once

#include <optional>
#include <vector>

#include "check/decide/small_tests.h"
#include "check/estimate/source.h"

namespace crescent::check {

/// Compares the directions with the stated index, if there is one.
std::optional<SmallFault> refraction(const Source& source, const std::vector<DeltaPart>& parts, const StreamKey& key);
/// Tests that draws at w_i of a part return to w_o with the power that reciprocity requires.
std::optional<SmallFault> reverse_path(const Source& source, const std::vector<DeltaPart>& parts, const StreamKey& key);

}  // namespace crescent::check
