// OpenEXR files: the images of skies and textures, and films, one file per sampler and exponent, one part per sample
// count, 32-bit float, scanlines top-down as viewers expect.
//   R G B            mean radiance, W/(sr m^2), linear Rec.709
//   luminance.Y      mean luminance X;  second_moment.Y  mean of X^2;  variance.Y  variance of the mean of X
//   largest.Y        largest single X;  horizon.Y, hits.Y  counts (unsigned)
// A reference has R G B, luminance.Y and error.Y (its own standard error of Y).
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/film.h"
#include "scene/sky.h"

namespace crescent {

/// String attributes of the header: (name, text).
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// Writes films (part name, film) to one file. Throws OutputError.
void write_exr(const std::string& path, const std::vector<std::pair<std::string, const Film*>>& parts,
    const Attributes& attributes);
void write_exr(const std::string& path, const std::vector<std::pair<std::string, const ReferenceFilm*>>& parts,
    const Attributes& attributes);

/// Writes the texels of a texture as half floats, Y alone if all are grey. Throws OutputError.
void write_texture(const std::string& path, const RgbImage& image);

// ---- Reads the image of a sky or of a texture: from an OpenEXR file, R, G and B, or Y alone, of its first part or of
// a layer (images/exr_layers.h), in half, float or integers; from Radiance HDR; or from a pack (scene/texture.h).

/// `layer`: of an OpenEXR file; "": its first part. Throws InputError with the file's name if it cannot be read, is no
/// image of this kind, or is larger than a sky or a texture may be; the size is checked before memory is taken for it.
/// Throws LayerError if the file has no such layer.
std::shared_ptr<const RgbImage> read_sky(const std::string& path, const std::string& layer = "");
std::shared_ptr<const RgbImage> read_texture(const std::string& path, const std::string& layer = "");

}  // namespace crescent
