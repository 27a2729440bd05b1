// What a lobe reflects of an even white light: A(theta_o) = integral of lobe(wo, wi) cos(theta_i) over the upper
// hemisphere. A function of one angle for every isotropic lobe; tabulated once, in double precision.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace crescent {

/// A at one angle by adaptive quadrature: Phong to about 1e-10, the half-vector lobes to about 1e-6.
double lobe_albedo(BrdfKind kind, double s, double alpha, double cos_o);

/// The same for many angles: cubic interpolation between quadratures, refined until its own error is below 1e-7
/// (1e-6 for the half-vector lobes) or the table is full: mirrors of alpha below 0.02 then state a larger one.
class LobeAlbedo {
public:
    LobeAlbedo(BrdfKind kind, double s, double alpha);
    double operator()(double cos_o) const;
    /// Largest difference to quadrature seen between the nodes, and the quadrature's own.
    double error() const { return error_; }

private:
    double interpolate(double x) const;
    std::vector<double> values_;  // at theta = x pi/2 / (size - 1)
    double error_ = 0;
};

}  // namespace crescent
