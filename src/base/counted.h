// Numbers of things in messages, in the singular or the plural.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace crescent {

/// Returns "1 mesh that emits" or "2 meshes that emit" for "mesh[es] that emit[s|]": of [ONE|MANY] the half that the
/// count takes, and [MANY] with a count other than 1 alone.
std::string counted(std::size_t count, std::string_view thing);

}  // namespace crescent
