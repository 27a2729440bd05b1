// The version of crescent, and the system it runs on.
#pragma once

#include <string>

namespace crescent {

std::string version();   // "0.2.0"
std::string commit();    // from `git describe`, or "unknown"
std::string compiler();  // "GNU 12.2.0"

}  // namespace crescent
