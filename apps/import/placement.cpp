// The box is that of the triangles, in double precision: vertices without a triangle do not count.
#include "placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crescent::importer {

ModelPlacement placement_of(const Model& model) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3d low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    const auto add = [&](const Part& part, const Transform& to) {
        for (const Triangle& triangle : part.triangles)
            for (const std::uint32_t corner : triangle) {
                const Vec3d p = to.placed(part.positions[corner]);
                for (const auto axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
                    low.*axis = std::min(low.*axis, p.*axis);
                    high.*axis = std::max(high.*axis, p.*axis);
                }
            }
    };
    for (const Part& part : model.parts) {
        if (part.copies.empty()) add(part, {});
        for (const Copy& copy : part.copies) add(part, copy.to);
    }
    double largest = 0, size = 0;
    for (const auto axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
        largest = std::max({largest, std::fabs(low.*axis), std::fabs(high.*axis)});
        size = std::max(size, high.*axis - low.*axis);
    }
    const bool is_placeable = largest <= 1e5 && size >= 1e-3 && largest <= 1e4 * size;
    if (!(size > 0) || !std::isfinite(size) || is_placeable) return {};
    const bool fits = size >= 1e-3 && size <= 1e5;
    return {0.5 * (low + high), fits ? 1 : std::ldexp(1, -std::ilogb(size))};
}

}  // namespace crescent::importer
