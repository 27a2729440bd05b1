// Sites at the origin with the world's axes for a frame, under a fill of radiance 1 and no other light. Each has its
// own index of a pixel, so its own random numbers.
#include "studies/furnace_sites.h"

#include <cmath>

#include "color/rgb.h"

namespace crescent::inline studies {

Surface furnace_surface(const SceneData& scene, const Shape& shape, bool lobe_only) {
    Surface surface = surface_of(shape.material, scene.s());
    if (lobe_only) surface.rho_d = {};
    return surface;
}

ShadingPoints furnace_sites(const Surface& surface, std::size_t count, double cos_o) {
    ShadingPoints sites;
    sites.lobe = surface.rho_s > 0 ? static_cast<int>(surface.brdf) : -1;
    sites.count = count;
    const auto fill = [&](std::vector<float>& array, double value) { array.assign(count, static_cast<float>(value)); };
    for (std::size_t i = 0; i < count; ++i) sites.pixel.push_back(static_cast<std::uint32_t>(i));
    sites.shape.assign(count, 0);
    fill(sites.wox, std::sqrt(1 - cos_o * cos_o)), fill(sites.woy, 0), fill(sites.woz, cos_o);
    fill(sites.s, surface.s), fill(sites.alpha, surface.alpha);
    fill(sites.diffuse, luminance(surface.rho_d)), fill(sites.rho_s, surface.rho_s);
    for (auto* zero :
        {&sites.px, &sites.py, &sites.pz, &sites.ty, &sites.tz, &sites.bx, &sites.bz, &sites.nx, &sites.ny})
        fill(*zero, 0);
    for (auto* one : {&sites.tx, &sites.by, &sites.nz}) fill(*one, 1);
    fill(sites.fill_d, luminance(surface.rho_d) / pi + 0.0);  // never -0
    fill(sites.fill_s, surface.rho_s);
    sites.lambert.assign(count, {surface.rho_d[0] / pi, surface.rho_d[1] / pi, surface.rho_d[2] / pi});
    sites.rho_s_exact.assign(count, surface.rho_s);
    sites.tint.assign(count, surface.tint);
    sites.pad();
    return sites;
}

}  // namespace crescent::inline studies
