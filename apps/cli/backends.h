// What computes films, by the name it has on the command line.
#pragma once

#include <memory>

#include "commands.h"
#include "crescent/crescent.h"

namespace crescent::cli {

/// Null for "cpu", which is built in. Throws InputError where flags do not fit together, OutputError where this build
/// has no such back end or the machine lacks a part of it.
std::shared_ptr<Backend> backend(const RunFlags& flags);

}  // namespace crescent::cli
