// Images of constant texels, in linear Rec.709, and their use as textures: a factor of a material's number that varies
// over a mesh. The nearest texel counts, and the image repeats in both directions.
//
//   u runs to the right and v up: (0, 0) is the bottom-left corner of the image, (1, 1) the top-right one. Rows are
//   kept from the top, so column = floor(u width), row = height - 1 - floor(v height), u and v less their floors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"

namespace crescent::inline scene {

inline constexpr int widest_texture = 8192;  // texels along each side

/// The texels of an image, row by row from the top, r g b each.
struct RgbImage {
    int width = 0, height = 0;
    std::vector<float> rgb;
    std::uint64_t hash = 0;  // of the content: XXH3 of width, height and the texels

    std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
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
std::string why_no_texture(const RgbImage& image, TextureOf of);

/// Returns the texel at finite texture coordinates.
Rgb texel_at(const RgbImage& image, double u, double v);

}  // namespace crescent::inline scene
