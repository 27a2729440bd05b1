// The directional albedo of a lobe under constant illumination: A(theta_o) = integral of lobe(wo, wi) cos(theta_i) over
// the upper hemisphere. A function of one angle for every isotropic lobe; tabulated once, in double precision.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "render/reference/disk_quadrature.h"
#include "scene/lobes/lobe.h"
#include "scene/shadow.h"

namespace crescent {

// ---- A BRDF's lobe along one fan of directions about its own peak or about any other axis, in double precision.

/// Returns the lobe's width across the plane of incidence over its width in that plane: lobes about half vectors are
/// streaks at grazing wo.
double lobe_stretch(const DiskPoint& point);

/// How the lobe of a point falls off; this determines where the nodes of a rule must lie.
struct LobeShape {
    double width =
        1;  // al of a fan within which the lobe keeps its height, rad; smallest value, across the plane of incidence
    double stretch = 1;
    double reach = pi;  // the lobe is negligible beyond
    explicit LobeShape(const DiskPoint& point);
    /// Returns the width in a fan at an azimuth whose cosine with the plane of incidence is c.
    double width_at(double c) const;
};

struct AlongLobe {
    double value = 0, error = 0;
};

/// Returns the integral of lobe cos(theta_i) sin(al) over [lo, hi], directions cos(al) axis + sin(al) side in the
/// local frame. Panels double in size from al = 0, `width` being the first; the error is the difference of two rules.
AlongLobe lobe_along(const DiskPoint& point, Vec3d axis, Vec3d side, Interval part, double width);

/// Called before every `steps` steps, a tenth of a microsecond each, on the calling thread, so that a page stays
/// responsive: near the horizon one albedo takes millions of steps.
using YieldToHost = std::function<void(std::size_t steps)>;

/// Returns A at one angle by adaptive quadrature: lobes about R to about 1e-10, lobes about the half vector to about
/// 1e-6.
double lobe_albedo(LobeKind kind, double s, double alpha, double cos_o, const YieldToHost& yield_to_host = {});

/// A at many angles: interpolation through five quadratures per cell. Cells are halved until their own error is below
/// 1e-7 (1e-6 for the half-vector lobes) or until they are 2^-15 of a right angle, which happens where a lobe's edge
/// crosses them.
class LobeAlbedo {
public:
    LobeAlbedo(LobeKind kind, double s, double alpha, const YieldToHost& yield_to_host = {});
    double operator()(double cos_o) const;
    /// Returns the largest difference from quadrature measured between the nodes near this angle, plus the quadrature's
    /// own error.
    double error(double cos_o) const;

private:
    struct Cell {
        double from = 0, size = 0;  // theta_o
        std::array<double, 5> value{};
        double error = 0;
    };
    const Cell& cell(double theta) const;
    std::vector<Cell> cells_;
};

}  // namespace crescent
