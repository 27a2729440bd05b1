// The .image file: the texels of a sky or of a texture as they are in memory, for programs that read no OpenEXR. Its
// hash is that of the content, so an experiment has one identity for an image and for its pack.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scene/sky.h"
#include "scene/texture.h"

namespace crescent::inline scene {

// ---- The file: little-endian, in this order.
//
//   char magic[8]         "crescent"
//   uint32 kind           0x67616d69, "imag"
//   uint32 version        1
//   uint32 width, height
//   uint64 hash           RgbImage::hash
//   float rgb[height][width][3]    rows from the top

inline constexpr std::size_t image_header_size = 32;

/// Returns RgbImage::hash of these texels.
std::uint64_t hash_of_texels(int width, int height, const std::vector<float>& rgb);
/// Returns the file's bytes.
std::string image_file(const RgbImage& image);
/// Returns whether a file that begins with these bytes is a pack.
bool is_image_file(std::string_view head);

/// The texels of an image along each side.
struct ImageSize {
    std::uint32_t width = 0, height = 0;
};
/// Reads the size from the first bytes of a file of `size` bytes; `name` is in messages. Throws InputError with the
/// file and the place in it.
ImageSize read_image_size(std::string_view head, std::uint64_t size, const std::string& name);
/// Reads a file; memory is bounded by the size of `bytes`. Throws InputError like read_image_size, and if the hash is
/// another one.
std::shared_ptr<const RgbImage> read_image_file(std::string_view bytes, const std::string& name);

// ---- Images from any file.

/// Why an image of this size cannot be a sky, or a texture; "" if it can.
std::string why_no_sky_of(std::int64_t width, std::int64_t height);
std::string why_no_texture_of(std::int64_t width, std::int64_t height);
/// Returns the hash of the content, as 16 hexadecimal digits.
std::string content_hash(const RgbImage& image);

}  // namespace crescent::inline scene
