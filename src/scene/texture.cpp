// Double precision; a coordinate just below a whole number may round up to the width, and counts as the last texel.
#include "scene/texture.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace crescent::inline scene {

std::string why_no_texture(const RgbImage& image, TextureOf of) {
    for (std::size_t k = 0; k < image.texels(); ++k) {
        const float* const t = &image.rgb[3 * k];
        const bool roughness = of == TextureOf::alpha;
        const auto good = [&](float x) { return x <= 1 && (roughness ? x > 0 : x >= 0); };
        if (good(t[0]) && good(t[1]) && good(t[2]) && (!roughness || (t[0] == t[1] && t[1] == t[2]))) continue;
        const std::size_t width = static_cast<std::size_t>(image.width);
        return fmt::format("texel ({}, {}), counted from the top-left: expected {}, found ({}, {}, {})", k % width,
            k / width, roughness ? "a grey roughness above 0, up to 1" : "an albedo from 0 to 1", t[0], t[1], t[2]);
    }
    return "";
}

Rgb texel_at(const RgbImage& image, double u, double v) {
    const auto step = [](double x, int size) {
        return std::min(static_cast<int>((x - std::floor(x)) * size), size - 1);
    };
    const auto column = static_cast<std::size_t>(step(u, image.width));
    const auto row = static_cast<std::size_t>(image.height - 1 - step(v, image.height));
    const float* const t = &image.rgb[3 * (row * static_cast<std::size_t>(image.width) + column)];
    return {double(t[0]), double(t[1]), double(t[2])};
}

}  // namespace crescent::inline scene
