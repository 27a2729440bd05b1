// Opens back ends by their name on the command line.
#pragma once

#include <memory>

#include "commands.h"
#include "crescent/crescent.h"

namespace crescent::cli {

/// Returns null for "cpu", which is built in. Throws InputError if flags do not fit together, OutputError if this build
/// has no such back end or the machine lacks a part of it.
std::shared_ptr<Backend> backend(const RunFlags& flags);

}  // namespace crescent::cli
