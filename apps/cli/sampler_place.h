// Where the sampler of `crescent check` is written.
#pragma once

#include <string>
#include <utility>

#include "commands.h"

namespace crescent::cli {

/// Returns the file of the sampler ("": a built-in one, or unknown) and the line of its function that draws (0:
/// unknown).
std::pair<std::string, unsigned> place_of_sampler(const CheckFlags& flags);

}  // namespace crescent::cli
