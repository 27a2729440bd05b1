// A disk light's part of the reflected radiance, without any randomness: the integral over the disk of
// f cos(theta_i) cos(theta_l) / r^2, less what bodies hide and what lies under the horizon. Double precision.
#pragma once

#include <cmath>
#include <complex>
#include <span>
#include <vector>

#include "base/vec.h"
#include "scene/lobes/all.h"
#include "scene/scene.h"
#include "scene/scene_data.h"
#include "scene/shadow.h"

namespace crescent::inline reference {

// ---- What one surface point makes of light from a point of a disk: the integrand of disk_quadrature.h, in double.

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

/// Per unit radiance difference: the Lambert part (without rho_d) and the lobe part (without rho_s) of
/// integral f cos dw over the visible disk, and how far each may be off: differences of two rules, summed.
struct DiskIntegral {
    double diffuse = 0, lobe = 0;
    double diffuse_error = 0, lobe_error = 0;
};

/// What may stand before a light: a body, or another light, which is nearer wherever it is met before.
struct Blocker {
    Occluder body;
    Between between = before_light;
    const Light* light = nullptr;  // which is not there from behind where it shines from one side alone
    Ball around = ball_around(body);
};

class DiskQuadrature {
public:
    /// Bodies that may stand before disk `k` of the scene, other lights that face the point among them.
    DiskQuadrature(const Scene& scene, std::size_t k);
    DiskIntegral operator()(const Hit& hit, const Surface& surface) const;
    /// The same for surfaces that differ in their lobe's exponent alone: out[k] for surfaces[k], the same bits.
    void operator()(const Hit& hit, std::span<const Surface> surfaces, std::span<DiskIntegral> out) const;

private:
    std::vector<const Blocker*> in_the_way(const Hit& hit, const Figure& figure) const;

    const Light& light_;
    std::vector<Blocker> blockers_;
};

// ---- A disk light that is open and above the horizon: Lambert's part in closed form, a soft lobe's by polar rules.

/// `frame` has the disk's normal for its axis. For lobes that are wide against the disk: rules of rising order until
/// two agree, and the error is the difference of the last two.
DiskIntegral whole_disk(const DiskPoint& point, const shapes::Disk& disk, const Frame<double>& frame);

}  // namespace crescent::inline reference
