// What shines. Radiance in W/(sr m^2), lengths in m.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <variant>

#include "base/errors.h"
#include "color/rgb.h"
#include "scene/shapes/all.h"

namespace crescent {

inline constexpr std::size_t most_disks = 64;  // disk lights in one scene: kernels hold the sums of each at hand

/// A flat figure that is seen in the directions of a light.
using Figure = std::variant<shapes::Disk, shapes::Quad>;

/// A disk that emits `radiance` from the side its normal points to (or both). Seen by sampled rays only.
struct DiskLight {
    std::string name;
    Vec3d center{}, normal{};
    double radius = 0;
    Rgb radiance{};
    bool two_sided = false;
    Place at;

    /// What it puts before the lights behind it.
    shapes::Disk body() const { return {center, normal, radius}; }
    /// An emitting side faces x. A disk whose plane passes through x, within 1e-6 of how far its points are, gives it
    /// nothing.
    bool shines_on(Vec3d x) const {
        const Vec3d d = center - x;
        const double along = dot(d, normal);
        return std::fabs(along) > 1e-6 * (std::sqrt(dot(d, d)) + radius) && (two_sided || along < 0);
    }
    /// In whose directions it is seen from x.
    Figure seen_from(Vec3d) const { return body(); }
};

}  // namespace crescent
