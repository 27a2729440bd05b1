// disk: a disk that emits from the side its normal points to, or from both.
#pragma once

#include "scene/lights/light_kind.h"

namespace crescent::lights {

struct Disk {
    static constexpr std::string_view name = "disk";
    static constexpr std::string_view summary = "a disk that shines from the side its normal points to, or from both";
    Vec3d center{}, normal{};  // normal: unit
    double radius = 0;
    bool two_sided = false;

    static constexpr auto parameters() {
        return std::array{parameter::place("center", &Disk::center, "Centre."),
            parameter::direction("normal", &Disk::normal, "The side that shines."),
            parameter::length("radius", &Disk::radius, "Radius."),
            parameter::flag("two_sided", &Disk::two_sided, "Emits from both sides.")};
    }

    /// Returns the body with which it hides the lights behind it.
    shapes::Disk body() const { return {center, normal, radius}; }
    bool shines_on(Vec3d x) const { return shines_flat(center - x, normal, radius, two_sided); }
    /// Returns the figure whose directions it covers as seen from x.
    Figure seen_from(Vec3d) const { return body(); }
    /// Returns its largest projected area over pi, m^2.
    double disk_area() const { return sqr(radius); }
};

}  // namespace crescent::lights
