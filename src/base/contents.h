// All of a file at once.
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <utility>

namespace crescent::inline base {

/// The bytes of a file; "" where it cannot be read.
inline std::string contents_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream all;
    all << file.rdbuf();
    return std::move(all).str();
}

}  // namespace crescent::inline base
