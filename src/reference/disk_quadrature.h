// A disk light's part of the reflected radiance, without any randomness: the integral over the disk of
// f cos(theta_i) cos(theta_l) / r^2, less what bodies hide and what lies under the horizon. Double precision.
#pragma once

#include <span>
#include <vector>

#include "scene/figure.h"
#include "scene/scene.h"
#include "scene/shadow.h"

namespace crescent::inline reference {

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

}  // namespace crescent::inline reference
