// plane: an infinite plane.
#pragma once

#include <cmath>

#include "scene/body.h"

namespace crescent::shapes {

struct Plane {
    static constexpr std::string_view name = "plane";
    static constexpr std::string_view summary = "an infinite plane";
    Vec3d point{}, normal{};  // normal: unit

    static constexpr auto parameters() {
        return std::array{parameter::place("point", &Plane::point, "A point of the infinite plane."),
            parameter::direction("normal", &Plane::normal, "The direction that it faces.")};
    }

    Intersection intersect(Vec3d x, Vec3d d) const { return crossing_at(plane_t(point, normal, x, d), normal); }

    std::array<Interval, 2> hidden(const Sight& s) const { return {project(point, normal, s).sides, {}}; }
    bool holds(Vec3d) const { return false; }

    Vec3d middle() const { return point; }
    double half_extent(Vec3d axis) const {
        return disk_reach(axis, normal) > 1e-6 * std::sqrt(dot(axis, axis)) ? never : 0;
    }
    std::array<Vec3d, 1> faces() const { return {normal}; }
    Azimuths azimuths(Vec3d, const Frame<double>&) const { return {}; }

    BodyNumbers numbers(Vec3d origin) const {
        const Vec3d a = point - origin;
        return {.a = a, .b = normal, .c = {}, .radius = 0, .offset = dot(normal, a)};
    }
    template <class F> static MaskOf<F> blocks(const PackedBody<F>& body, Vec3<F> o, Vec3<F> d, F lo, F hi) {
        return within(plane_at(body.b, body.offset, o, d), lo, hi);
    }
};

}  // namespace crescent::shapes
