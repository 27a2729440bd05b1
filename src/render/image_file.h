// Reads the image of a sky or of a texture: from an OpenEXR file, R, G and B, or Y alone, of its first part, in half,
// float or integers; or from a pack (scene/image_pack.h).
#pragma once

#include <memory>
#include <string>

#include "scene/sky.h"

namespace crescent::inline render {

/// Throws InputError with the file's name if it cannot be read, is no image of this kind, or is larger than a sky or a
/// texture may be; the size is checked before memory is taken for it.
std::shared_ptr<const RgbImage> read_sky(const std::string& path);
std::shared_ptr<const RgbImage> read_texture(const std::string& path);

}  // namespace crescent::inline render
