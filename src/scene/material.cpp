// rho_s is the luminance of a coloured lobe and its tint the colour over that, so that grey lobes keep their bits.
// alpha is sqrt(2 / (s + 2)) where it is not given (Walter et al. 2007).
#include "scene/material.h"

#include <cmath>

namespace crescent::inline scene {

void Material::set_specular(const Rgb& color) {
    const double y = luminance(color);
    const bool grey = color[0] == color[1] && color[1] == color[2];
    rho_s = grey ? color[0] : y;
    specular = grey ? std::nullopt : std::optional<Rgb>(color);
}

Surface surface_of(const Material& m, double common_s) {
    const double s = m.s.value_or(common_s);
    Surface out = {m.rho_d, m.rho_s, m.brdf, s, m.alpha.value_or(std::sqrt(2 / (s + 2)))};
    for (std::size_t c = 0; m.specular && m.rho_s > 0 && c < 3; ++c) out.tint[c] = (*m.specular)[c] / m.rho_s;
    return out;
}

}  // namespace crescent::inline scene
