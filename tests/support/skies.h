// Skies for tests.
#pragma once

#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "scene/sky.h"

namespace crescent::test {

/// A sky of these texels, twice as wide as high.
inline SkyLight sky_of(int width, std::vector<float> rgb) {
    auto image = std::make_shared<RgbImage>();
    image->width = width;
    image->height = width / 2;
    image->rgb = std::move(rgb);
    SkyLight light;
    light.image = std::move(image);
    return light;
}

inline SkyLight constant_sky(float r, float g, float b) {
    std::vector<float> rgb;
    for (int k = 0; k < 8 * 4; ++k) rgb.insert(rgb.end(), {r, g, b});
    return sky_of(8, std::move(rgb));
}

/// Texels over three orders of magnitude, an eighth of them black.
inline SkyLight noisy_sky(int height, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> rgb(6 * static_cast<std::size_t>(height) * static_cast<std::size_t>(height));
    for (std::size_t k = 0; k < rgb.size(); k += 3) {
        const float dim = static_cast<float>(1u << (random() % 10)) / 64;
        const bool black = random() % 8 == 0 && k > 0;
        for (std::size_t c = 0; c < 3; ++c)
            rgb[k + c] = black ? 0 : dim * (0.5f + static_cast<float>(random() % 256) / 256);
    }
    return sky_of(2 * height, std::move(rgb));
}

}  // namespace crescent::test
