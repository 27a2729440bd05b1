// The header of an NPY file (NumPy format 1 to 3), and the floats in it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"

namespace crescent {

/// The longest header that is read.
inline constexpr std::size_t longest_npy_header = 65536 + 12;

struct NpyHeader {
    std::size_t bytes = 0;  // of a float: 2, 4 or 8
    bool swapped = false;   // the file's byte order is not this machine's
    bool by_column = false;
    std::vector<std::uint64_t> shape;
    std::size_t end = 0;  // the byte after the header
};

/// Reads the header in a file's first bytes: all of them, or longest_npy_header. Accepts floats of any size and an
/// array of any shape; else throws InputError with what was expected.
NpyHeader read_npy_header(const std::string& path, std::string_view first_bytes);

/// Returns the float in the file's bytes.
double npy_number(const NpyHeader& header, const char* bytes);

}  // namespace crescent
