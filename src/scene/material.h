// What a surface reflects: f = rho_d/pi + rho_s * lobe(s or alpha), albedos in [0, 1], f in 1/sr.
#pragma once

#include <optional>

#include "color/rgb.h"
#include "lobes/info.h"

namespace crescent {

/// As it is given. A Lambert surface has rho_s = 0; its s only steers the arms.
struct Material {
    Rgb rho_d{};
    double rho_s = 0;
    LobeKind brdf{0};
    std::optional<double> s;      // Phong exponent
    std::optional<double> alpha;  // GGX roughness, (0, 1], no remapping
    bool inherits_s = false;      // s is not the shape's own but the scene's
};

/// The same with every default filled in.
struct Surface {
    Rgb rho_d{};
    double rho_s = 0;
    LobeKind brdf{0};
    double s = 0, alpha = 0;
};

/// A material's surface in a scene whose common exponent is s. Where it states no alpha: sqrt(2/(s+2)), as wide as a
/// Blinn-Phong lobe of exponent s (Walter et al. 2007), so that a GGX arm has something to aim by on any surface.
Surface surface_of(const Material& material, double common_s);

}  // namespace crescent
