// Libraries of materials of OBJ files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model.h"

namespace crescent::importer {

/// Where an image is on a part: uv' = scale uv + offset.
struct UvPlacement {
    Vec2<double> scale{1, 1}, offset{0, 0};
};

struct MtlMaterial {
    Material material;
    std::string image = {};  // that multiplies the colour, as it is written; "": none
    UvPlacement uv{};        // of the image
};

struct Mtl {
    std::vector<MtlMaterial> materials;
    Kinds statements;              // without effect here, and how many materials have them
    std::size_t before_first = 0;  // statements before the first material
    Kinds options;                 // of the images of colours
};

/// Reads an MTL file: Kd, Ks, Ke, Ns, Pr, Pm and map_Kd with -o and -s. All else is counted by its name, unless its
/// value states nothing, as `d 1`. An exponent becomes a roughness (Blinn-Phong of the same width: Walter et al. 2007).
Mtl read_mtl(std::string_view file);

}  // namespace crescent::importer
