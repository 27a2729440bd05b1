// What one surface point makes of light from a point of a disk: the integrand of disk_quadrature.h, in double.
#pragma once

#include <cmath>
#include <complex>

#include "color/rgb.h"
#include "lobes/all.h"
#include "scene/scene.h"

namespace crescent::inline reference {

using Parts = std::complex<double>;  // diffuse, lobe: two integrands in one pass

/// What one surface point makes of a direction to the disk.
struct DiskPoint {
    Vec3d x, wo;
    Frame<double> frame;
    Surface surface;
    Vec3d light_normal;

    /// The lobe times cos(theta_i) cos(theta_l) / r^2 at y, in 1/m^2, rho_s apart.
    double lobe_at(Vec3d y) const {
        const Vec3d d = y - x;
        const double r2 = dot(d, d), inverse = 1 / std::sqrt(r2);
        const Vec3d wi = frame.to_local(d * inverse);
        return wi.z > 0 ? wi.z * std::fabs(dot(d, light_normal)) * inverse / r2 * lobe(wi) : 0.0;
    }
    double lobe(Vec3d wi) const { return lobe_value(surface.brdf, surface.s, surface.alpha, wo, wi); }
    /// How many times the lobe's width goes into the angle t. A lobe about the half vector is a streak at grazing wo.
    double sharpness(double t) const {
        if (!(surface.rho_s > 0)) return 0;
        const LobeInfo& lobe = lobe_info(surface.brdf);
        const double across = t * std::sqrt(lobe.exponent(surface.s, surface.alpha));
        return lobe.about_mirror ? across : across / wo.z;
    }
    /// Y of what the pair is worth under light of radiance 1.
    double weigh(Parts p) const {
        return luminance(surface.rho_d) * std::abs(p.real()) + surface.rho_s * std::abs(p.imag());
    }
};

}  // namespace crescent::inline reference
