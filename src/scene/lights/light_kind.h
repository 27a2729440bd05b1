// Shared by the kinds of light: how a surface point sees one, in double precision for the references and, except for
// disks, as samplers and kernels have it. (Disks have forms of their own there, samplers/sampler.h.)
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <variant>

#include "scene/shapes/all.h"

namespace crescent {

/// A flat figure that covers the directions of a light.
using Figure = std::variant<shapes::Disk, shapes::Quad>;

/// Returns whether an emitting side of a flat light faces the point; d leads from the point to its centre. A light
/// whose plane passes through the point, within 1e-6 of the distance of its own points, contributes nothing.
inline bool shines_flat(Vec3d d, Vec3d normal, double radius, bool two_sided) {
    const double height = dot(d, normal);
    return std::fabs(height) > 1e-6 * (std::sqrt(dot(d, d)) + radius) && (two_sided || height < 0);
}

/// A light as a surface point sees it, in the point's local frame. The meaning of the vectors and numbers depends on
/// the kind.
template <class F> struct LocalLight {
    std::size_t kind = 0;  // index in LightKinds
    F power{};             // its share in the choice among lights
    Vec3<F> a{}, b{}, c{};
    std::array<F, 7> number{};
};
/// The same in double: nine components of the vectors, then the numbers.
inline constexpr std::size_t local_numbers = 16;
struct LightNumbers {
    Vec3d a{}, b{}, c{};
    std::array<double, 7> number{};
};

/// A direction towards a light and its density in 1/sr; 0 if the light does not reach the point.
template <class F> struct Aimed {
    Vec3<F> wi;
    F pdf;
};

}  // namespace crescent
