// What a surface reflects: f = rho_d/pi + rho_s * lobe(s or alpha), albedos in [0, 1], f in 1/sr.
#pragma once

#include <optional>

#include "color/rgb.h"
#include "lobes/info.h"

namespace crescent::inline scene {

/// As it is given. A Lambert surface has rho_s = 0; its s only steers the arms.
struct Material {
    Rgb rho_d{};
    double rho_s = 0;  // of the lobe; where it has a colour, its luminance
    LobeKind brdf{0};
    std::optional<double> s;        // Phong exponent
    std::optional<double> alpha;    // GGX roughness, (0, 1], no remapping
    bool inherits_s = false;        // s is not the shape's own but the scene's
    std::optional<Rgb> specular{};  // the lobe's albedo where it has a colour, rho_s being its luminance

    /// Gives the lobe an albedo of a colour; a grey one is a number.
    void set_specular(const Rgb& color);
};

/// The same with every default filled in.
struct Surface {
    Rgb rho_d{};
    double rho_s = 0;
    LobeKind brdf{0};
    double s = 0, alpha = 0;
    Rgb tint = {1, 1, 1};  // the lobe's albedo is rho_s * tint

    /// Y of what the lobe reflects of light of this colour, over rho_s.
    double tinted(const Rgb& light) const {
        return luminance(Rgb{light[0] * tint[0], light[1] * tint[1], light[2] * tint[2]});
    }
};

/// A material's surface in a scene whose common exponent is s. Where it states no alpha: sqrt(2/(s+2)), as wide as a
/// Blinn-Phong lobe of exponent s (Walter et al. 2007), so that a GGX arm has something to aim by on any surface.
Surface surface_of(const Material& material, double common_s);

}  // namespace crescent::inline scene
