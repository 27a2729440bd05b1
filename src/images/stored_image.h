// Samples of an image file that stb_image decodes in a child process (image_host.h), and the header of Radiance HDR
// (Ward 1991, "Real Pixels").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <vector>

#include "base/vec.h"
#include "images/image_host.h"
#include "images/open_file.h"

namespace crescent {

/// Samples as they are in the file: rows from the top, channels interleaved.
struct StoredImage {
    ImageHead head;
    std::vector<unsigned char> samples;
    std::optional<bool> srgb;  // whether it is encoded, if the file states it

    double levels() const { return head.bytes == 1 ? 256 : head.bytes == 2 ? 65536 : 0; }
    double sample(std::size_t k) const {
        if (head.bytes == 1) return samples[k];
        if (head.bytes == 2) {
            std::uint16_t value = 0;
            std::memcpy(&value, samples.data() + 2 * k, sizeof value);
            return value;
        }
        float value = 0;
        std::memcpy(&value, samples.data() + 4 * k, sizeof value);
        return static_cast<double>(value);
    }
};

/// Starts the child process and reads what it decodes: JPEG, BMP, TGA, PNM, Radiance HDR. Throws InputError.
StoredImage decoded(const OpenFile& file);

/// What the header of Radiance HDR states besides the pixels.
struct HdrHeader {
    int width = 0, height = 0;
    Rgb unit{1, 1, 1};                               // factor of a stored value
    std::optional<std::array<double, 8>> primaries;  // x and y of red, green, blue and white
};

/// Whether these are the primaries of colours and a white point.
using ArePrimaries = std::function<bool(const std::array<double, 8>&)>;
/// Throws InputError with the line, also for primaries that are none.
HdrHeader hdr_header(const OpenFile& file, const ArePrimaries& are_primaries);

}  // namespace crescent
