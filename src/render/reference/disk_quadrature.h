// A disk light's part of the reflected radiance by quadrature: the integral over the disk of f cos(theta_i)
// cos(theta_l) / r^2, without the parts that bodies hide and the part below the horizon. Double precision.
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

namespace crescent {

// ---- The integrand: what one surface point reflects of the light from a point of a disk, in
// double.

using Parts = std::complex<double>;  // diffuse, lobe: two integrands in one pass

/// What one surface point reflects from a direction to the disk.
struct DiskPoint {
    Vec3d x, wo;
    Frame<double> frame;
    Surface surface;
    Vec3d light_normal;

    /// Returns the lobe times cos(theta_i) cos(theta_l) / r^2 at y, in 1/m^2, without rho_s.
    double lobe_at(Vec3d y) const {
        const Vec3d d = y - x;
        const double r2 = dot(d, d), inverse = 1 / std::sqrt(r2);
        const Vec3d wi = frame.to_local(d * inverse);
        return wi.z > 0 ? wi.z * std::fabs(dot(d, light_normal)) * inverse / r2 * lobe(wi) : 0.0;
    }
    double lobe(Vec3d wi) const { return lobe_value(surface.brdf, surface.s, surface.alpha, wo, wi); }
    /// Returns the angle t over the lobe's width. A lobe about the half vector is a streak at grazing wo.
    double sharpness(double t) const {
        if (!(surface.rho_s > 0)) return 0;
        const LobeInfo& lobe = lobe_info(surface.brdf);
        const double ratio = t * std::sqrt(lobe.exponent(surface.s, surface.alpha));
        return lobe.about_mirror ? ratio : ratio / wo.z;
    }
    /// Returns Y of the pair under light of radiance 1.
    double weigh(Parts p) const {
        return luminance(surface.rho_d) * std::abs(p.real()) + surface.rho_s * std::abs(p.imag());
    }
};

/// Per unit radiance difference: the Lambert part (without rho_d) and the lobe part (without rho_s) of integral f cos
/// dw over the visible disk, and a bound on the error of each: differences of two rules, summed.
struct DiskIntegral {
    double diffuse = 0, lobe = 0;
    double diffuse_error = 0, lobe_error = 0;
};

/// What may block a light: a body, or another light if it is nearer.
struct Blocker {
    Occluder body;
    Between limits = before_light;
    const Light* light = nullptr;  // absent as seen from behind if it is one-sided
    Ball ball = ball_around(body);
};

class DiskQuadrature {
public:
    /// Takes the bodies that may block disk `k` of the scene, including other lights that face the point.
    DiskQuadrature(const Scene& scene, std::size_t k);
    DiskIntegral operator()(const Hit& hit, const Surface& surface) const;
    /// For surfaces that differ only in their lobe's exponent: out[k] for surfaces[k], with the same bits.
    void operator()(const Hit& hit, std::span<const Surface> surfaces, std::span<DiskIntegral> out) const;

private:
    std::vector<const Blocker*> in_the_way(const Hit& hit, const Figure& figure) const;

    const Light& light_;
    std::vector<Blocker> blockers_;
};

// ---- A disk light that is unoccluded and above the horizon: Lambert's part in closed form, a wide lobe's by polar
// rules.

/// `frame` has the disk's normal as its axis. For lobes that are wide compared with the disk: rules of rising order
/// until two agree; the error is the difference of the last two.
DiskIntegral whole_disk(const DiskPoint& point, const shapes::Disk& disk, const Frame<double>& frame);

}  // namespace crescent
