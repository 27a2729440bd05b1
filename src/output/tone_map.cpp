// Neutral: toe, compression of the peak, desaturation, with the constants of the specification. sRGB: the standard's
// two pieces; bytes by comparison with the decoded (k - 1/2)/255, from a first guess in 1024 steps.
#include "output/tone_map.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"

namespace crescent::inline output {

namespace {

// The constants of the specification: F90 reflectance 4 %, compression begins at 0.8 - F90, desaturation K_d.
constexpr double fresnel = 0.04;
constexpr double start = 0.8 - fresnel;
constexpr double desaturation = 0.15;

// Linear values at which round(255 srgb_encode) steps from k - 1 to k, and for each of 1024 equal steps of the linear
// range the byte at its lower end: two or three comparisons then determine any value.
struct Thresholds {
    std::array<double, 257> step;
    std::array<unsigned char, 1025> first;
    Thresholds() {
        step[0] = 0;
        for (int k = 1; k < 256; ++k) step[k] = srgb_decode((k - 0.5) / 255);
        step[256] = 2;  // never reached
        int k = 0;
        for (int i = 0; i <= 1024; ++i) {
            while (i / 1024.0 >= step[k + 1]) ++k;
            first[i] = static_cast<unsigned char>(k);
        }
    }
};

}  // namespace

Rgb neutral(const Rgb& colour) {
    auto [r, g, b] = colour;
    double x = std::min({r, g, b});
    // The toe removes the reflection of the surface, 4 %: x - 6.25 x^2 = x (1 - x / (4 fresnel)) meets it at x = 2
    // fresnel.
    double offset = x < 2 * fresnel ? x - x * x / (4 * fresnel) : fresnel;
    r -= offset, g -= offset, b -= offset;
    double peak = std::max({r, g, b});
    if (peak < start) return {r, g, b};

    constexpr double d = 1 - start;
    double new_peak = 1 - d * d / (peak + d - start);
    double scale = new_peak / peak;
    double white = 1 - 1 / (desaturation * (peak - new_peak) + 1);
    auto mix = [&](double c) { return c * scale * (1 - white) + new_peak * white; };
    return {mix(r), mix(g), mix(b)};
}

double srgb_encode(double linear) {
    double x = std::clamp(linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * math::pow(x, 1 / 2.4) - 0.055;
}

double srgb_decode(double encoded) {
    double x = std::clamp(encoded, 0.0, 1.0);
    return x <= 0.04045 ? x / 12.92 : math::pow((x + 0.055) / 1.055, 2.4);
}

unsigned char srgb_byte(double linear) {
    static const Thresholds table;
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    int k = table.first[static_cast<int>(linear * 1024)];
    while (linear >= table.step[k + 1]) ++k;
    return static_cast<unsigned char>(k);
}

Srgb8 photograph(const Rgb& radiance, double exposure) {
    Rgb exposed;
    for (int c = 0; c < 3; ++c) {
        if (!std::isfinite(radiance[c])) return not_a_number_colour;
        exposed[c] = std::max(0.0, exposure * radiance[c]);
    }
    Rgb mapped = neutral(exposed);
    return {srgb_byte(mapped[0]), srgb_byte(mapped[1]), srgb_byte(mapped[2])};
}

}  // namespace crescent::inline output
