// A GL film compared with the CPU's. If no sample of a pixel changed sides of an edge (the same number below the
// horizon, the same number on the lights), Y may differ only by rounding; if one did, the pixel is counted and not
// compared.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "crescent/crescent.h"

namespace crescent::gl::test {

// One sample's X = f L cos / p. Directions are off by about 1.5e-7 absolute, so cos by the same and X relative to the
// larger of itself and the pixel's Lambert level by a few such steps; divisions and powers in a sampler add to that.
// The samplers state their bounds: each is about three times the largest difference among 270,000 samples on llvmpipe,
// given in docs/gl.md.
/// A GPU's compiler may contract a b + c, and its square roots and reciprocals are accurate to 1 or 2 ULP instead of
/// half of one.
inline constexpr double gpu_factor = 8;
/// The share of samples that may change sides: an edge must be within the 1.5e-7 by which a direction is off. Each of
/// the scene's edges is a few units long, so about 1e-6 of the samples of a sampler that covers the hemisphere, more if
/// a sampler aims at an edge (phong at grazing angles, light-area at outlines).
inline constexpr double software_side_rate = 1e-5, gpu_side_rate = 8e-5;

struct Difference {
    double largest = 0;  // relative, of pixels where no sample changed sides
    std::uint64_t changed = 0, pixels = 0;
    std::uint64_t bad_cpu = 0, bad_gl = 0;
};

inline void compare(const Scene& scene, const ShapeMap& shapes, const Film& cpu, const Film& gl, Difference& out) {
    const int width = scene.image().width;
    out.bad_cpu += cpu.invalid;
    out.bad_gl += gl.invalid;
    for (std::size_t at = 0; at < cpu.size(); ++at) {
        if (shapes.shape[at] < 0) continue;
        ++out.pixels;
        if (cpu.light_hits[at] != gl.light_hits[at] || cpu.horizon[at] != gl.horizon[at]) {
            ++out.changed;
            continue;
        }
        const Surface surface =
            scene.surface(*scene.primary(static_cast<int>(at) % width, static_cast<int>(at) / width));
        const Rgb& fill = scene.fill();
        const double level =
            luminance(Rgb{fill[0] * surface.rho_d[0], fill[1] * surface.rho_d[1], fill[2] * surface.rho_d[2]});
        const double a = static_cast<double>(cpu.y[at]), b = static_cast<double>(gl.y[at]);
        const double relative = std::fabs(a - b) / std::max({a, b, level});
        if (!(relative <= out.largest)) out.largest = relative;  // a NaN stays
    }
}

}  // namespace crescent::gl::test
