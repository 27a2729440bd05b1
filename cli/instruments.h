// What computes films, by the name it has on the command line.
#pragma once

#include <memory>
#include <string>

#include "crescent.h"

namespace crescent::cli {

/// Null for "cpu", which is built in. Throws OutputError where this build has no such instrument.
std::shared_ptr<Instrument> instrument(const std::string& name);

}  // namespace crescent::cli
