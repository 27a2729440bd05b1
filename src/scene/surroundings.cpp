// None of these is inline: kernels are compiled for one instruction set each, and share this code.
#include "scene/surroundings.h"

namespace crescent::inline scene {

void sky_radiance(const Surroundings& around, std::uint32_t texel, Vec3f d, float* rgb) {
    if (!around.sky) return;
    const Rgb radiance = around.sky->radiance(texel == no_texel ? around.sky->texel_at(widen(d)) : texel);
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = static_cast<float>(radiance[c]);
}

double sky_pdf(const Surroundings& around, Vec3d d) {
    return around.sky ? around.sky->pdf(around.sky->texel_at(d)) : 0;
}

SkyDraw sample_sky(const Surroundings& around, double u, double v) {
    return around.sky ? around.sky->sample(u, v) : SkyDraw{{0, 1, 0}, no_texel, 0};
}

}  // namespace crescent::inline scene
