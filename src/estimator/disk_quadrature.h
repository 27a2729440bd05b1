// A disk light's part of the reflected radiance, without any randomness: the integral over the disk of
// f cos(theta_i) cos(theta_l) / r^2, less what bodies hide and what lies under the horizon. Double precision.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "scene/shadow.h"

namespace crescent {

/// Per unit radiance difference: the Lambert part (without rho_d) and the lobe part (without rho_s) of
/// integral f cos dw over the visible disk, and an error bound from two rules of different order.
struct DiskIntegral {
    double diffuse = 0, lobe = 0;
    double diffuse_error = 0, lobe_error = 0;
};

class DiskQuadrature {
public:
    /// Bodies that may stand before disk `k` of the scene, other lights that face the point among them.
    DiskQuadrature(const Scene& scene, std::size_t k);
    DiskIntegral operator()(const Hit& hit, const Surface& surface) const;

private:
    const DiskLight& disk_;
    Frame<double> frame_;
    std::vector<Occluder> bodies_;
};

}  // namespace crescent
