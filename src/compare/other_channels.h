// The channels of two files besides those that are compared: renders with the same colours may differ in them.
#pragma once

#include <string>

#include "compare/image_file.h"

namespace crescent {

/// Describes the channels that both files have, that are not tested and that differ: "A in 12 pixels, Z in 3"; "" if
/// there are none. Throws InputError.
std::string differing_channels(const std::string& a, const std::string& b, const ReadingOptions& reading);

}  // namespace crescent
