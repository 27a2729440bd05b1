// Numbers in the bytes of glTF and STL files, which are little-endian on every machine.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace crescent::importer {

/// Returns the number whose bytes begin here, aligned or not.
template <class T> T little_endian(const char* bytes) {
    std::array<char, sizeof(T)> ordered;
    std::copy_n(bytes, sizeof(T), ordered.begin());
    if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(ordered);
    return std::bit_cast<T>(ordered);
}

}  // namespace crescent::importer
