// The version of crescent, and the system it runs on.
#pragma once

#include <string>

namespace crescent {

std::string version();   // "1.2.3", of the file VERSION
std::string commit();    // from `git describe`, or "unknown"
std::string compiler();  // "GNU 12.2.0"

}  // namespace crescent
