// A BRDF's lobe along one fan of directions (fan.h) about its own peak or about any other axis. Double precision.
#pragma once

#include "reference/disk_point.h"
#include "scene/shadow.h"

namespace crescent::inline reference {

/// A lobe's width across the plane of incidence over its width in it: lobes about half vectors are streaks at grazing
/// wo.
double lobe_stretch(const DiskPoint& point);

/// How the lobe of a point falls off, which decides where a rule's nodes must lie.
struct LobeShape {
    double width =
        1;  // al of a fan within which the lobe keeps its height, rad; at its narrowest: across the plane of incidence
    double stretch = 1;
    double reach = pi;  // beyond, nothing of it is left
    explicit LobeShape(const DiskPoint& point);
    /// Width in a fan at an azimuth whose cosine with the plane of incidence is c.
    double width_at(double c) const;
};

struct AlongLobe {
    double value = 0, error = 0;
};

/// Integral of lobe cos(theta_i) sin(al) over [lo, hi], directions cos(al) axis + sin(al) aside in the local frame.
/// Panels that double in size from al = 0 on, `width` being the first; the error is the difference of two rules.
AlongLobe lobe_along(const DiskPoint& point, Vec3d axis, Vec3d aside, Interval part, double width);

}  // namespace crescent::inline reference
