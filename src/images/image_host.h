// The child process that decodes JPEG, BMP, TGA, PNM and Radiance HDR with stb_image: its decoders are not made for
// hostile files, so it may die, and that is reported. Its memory and its time are limited.
#pragma once

#include <cstdint>

namespace crescent {

/// A program with this name as its first word decodes the file that is its descriptor 3 before main(), and exits.
/// Not inline: a use of this name links the decoders.
extern const char* const image_host_name;

/// Budgets: 4 GiB hold a picture of 16384 x 16384 pixels with the copies that stb_image makes of it; a minute decodes
/// about 10 such pictures.
inline constexpr std::uint64_t image_host_memory = std::uint64_t{4} << 30;
inline constexpr std::uint64_t image_host_seconds = 60;

/// What it writes to standard output, before the samples: rows from the top, `channels` samples a pixel of `bytes`
/// bytes each (1, 2: unsigned; 4: float) in the byte order of the machine. If `bytes` is 0, `width` bytes of a message
/// follow instead.
struct ImageHead {
    std::uint32_t width = 0, height = 0, channels = 0, bytes = 0;
};

}  // namespace crescent
