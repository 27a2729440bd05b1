// Where delta parts lead: a smooth boundary mirrors and refracts by the index that is stated (Snell), a thin wall lets
// straight through, and light goes back the way that it came with as much of it (Helmholtz).
#pragma once

#include <optional>

#include "check/decide/small_tests.h"

namespace crescent::check {

/// Against the stated index, where there is one.
std::optional<SmallFault> refraction(const Source& source, const std::vector<DeltaPart>& parts, const StreamKey& key);
/// Draws at w_i of a part lead back to w_o, with the power that reciprocity gives.
std::optional<SmallFault> way_back(const Source& source, const std::vector<DeltaPart>& parts, const StreamKey& key);

}  // namespace crescent::check
