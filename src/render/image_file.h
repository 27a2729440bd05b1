// Reads the image of a sky from an OpenEXR file: R, G and B, or Y alone, of its first part, in half, float or integers.
#pragma once

#include <memory>
#include <string>

#include "scene/sky.h"

namespace crescent::inline render {

/// Throws InputError with the file's name if it cannot be read, is no image of this kind, or is larger than a sky may
/// be; the size is checked before memory is taken for it.
std::shared_ptr<const SkyImage> read_sky(const std::string& path);

/// Writes one, for programs that make skies. Throws OutputError.
void write_sky(const std::string& path, const SkyImage& image);

/// Returns the hash of the content, as 16 hexadecimal digits.
std::string content_hash(const SkyImage& image);

/// Makes an image with its hash.
std::shared_ptr<const SkyImage> sky_image(int width, int height, std::vector<float> rgb);

}  // namespace crescent::inline render
