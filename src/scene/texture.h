// Images of constant texels, in linear Rec.709, and their use as textures: a factor of a material's number that varies
// over a mesh. The nearest texel counts, and the image repeats in both directions.
//
//   u runs to the right and v up: (0, 0) is the bottom-left corner of the image, (1, 1) the top-right one. Rows are
//   kept from the top, so column = floor(u width), row = height - 1 - floor(v height), u and v less their floors.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace crescent {

inline constexpr int widest_texture = 8192;  // texels along each side

/// Returns the value of an IEEE 754 binary16 number, exactly.
inline float value_of_half(std::uint16_t bits) {
    const std::uint32_t magnitude = bits & 0x7fffu, sign = static_cast<std::uint32_t>(bits & 0x8000u) << 16;
    // The exponent's bias of 127 less that of 15, which also brings numbers without a leading 1 to their place.
    const float value = std::bit_cast<float>(magnitude << 13) * 0x1p112f;
    const std::uint32_t not_finite = magnitude >= 0x7c00u ? 0x7f800000u : 0u;
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) | not_finite | sign);
}

/// The texels of an image, row by row from the top, r g b each: in single precision, or in the half precision of their
/// file, which takes half of the memory.
struct RgbImage {
    int width = 0, height = 0;
    std::vector<float> rgb;             // empty if there are halves
    std::vector<std::uint16_t> halves;  // IEEE 754 binary16
    std::uint64_t hash = 0;             // of the content: XXH3 of width, height and the texels in single precision

    /// Returns the number of texels.
    std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    /// Returns how many numbers they have.
    std::size_t size() const { return rgb.size() + halves.size(); }
    /// Returns one of them.
    float operator[](std::size_t k) const { return halves.empty() ? rgb[k] : value_of_half(halves[k]); }
    /// Fetches one of them from memory, as a hint.
    void prefetch(std::size_t k) const {
        if (halves.empty()) __builtin_prefetch(&rgb[k]);
        else __builtin_prefetch(&halves[k]);
    }
    /// Sets one of them to 0.
    void set_zero(std::size_t k) {
        if (halves.empty()) rgb[k] = 0;
        else halves[k] = 0;
    }
};

/// A texture of a mesh's material.
struct Texture {
    std::optional<std::string> file;        // relative to the experiment's; none: no texture
    std::shared_ptr<const RgbImage> image;  // its content, once read
};

/// What the texels of a texture multiply.
enum class TextureOf { rho_d, alpha };

/// Where an image cannot be such a texture: the texel and what is wrong there; "" if it can. An albedo is from 0 to 1;
/// a roughness is above 0, up to 1, and grey.
std::string why_no_texture(const RgbImage& image, TextureOf property);

/// Returns the texel at finite texture coordinates.
Rgb texel_at(const RgbImage& image, double u, double v);

// ---- The .image file: the texels of a sky or of a texture as they are in memory, for programs that read no OpenEXR.
// Its hash is that of the content, so an experiment has one identity for an image and for its pack. Little-endian, in
// this order.
//
//   char magic[8]         "crescent"
//   uint32 kind           0x67616d69, "imag"
//   uint32 version        1
//   uint32 width, height
//   uint64 hash           RgbImage::hash
//   float rgb[height][width][3]    rows from the top

inline constexpr std::size_t image_header_size = 32;

/// Returns what RgbImage::hash is for its texels.
std::uint64_t hash_of_texels(const RgbImage& image);
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
/// Returns the smallest number of the texels; NaN does not count.
float smallest_number(const RgbImage& image);
/// Returns the hash of the content, as 16 hexadecimal digits.
std::string content_hash(const RgbImage& image);

}  // namespace crescent
