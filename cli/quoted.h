// A word as a shell reads it back.
#pragma once

#include <string>

namespace crescent::cli {

std::string quoted(const std::string& word);

}  // namespace crescent::cli
