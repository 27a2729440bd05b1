// disk: all points of a plane within one distance of a centre.
#pragma once

#include <cmath>

#include "scene/body.h"

namespace crescent::shapes {

struct Disk {
    static constexpr std::string_view name = "disk";
    static constexpr std::string_view summary = "a disk, which faces along its normal";
    Vec3d center{}, normal{};  // normal: unit
    double radius = 0;

    static constexpr auto parameters() {
        return std::array{parameter::place("center", &Disk::center, "Centre."),
            parameter::length("radius", &Disk::radius, "Radius."),
            parameter::direction("normal", &Disk::normal, "The direction that it faces.")};
    }

    Intersection intersect(Vec3d x, Vec3d d) const {
        const double t = plane_t(center, normal, x, d);
        if (t == never) return {};
        const Vec3d p = x + t * d - center;
        return dot(p, p) <= radius * radius ? crossing_at(t, normal) : Intersection{};
    }

    std::array<Interval, 2> hidden(const Sight& s) const {
        const OnPlane m = project(center, normal, s);
        const double r2 = radius * radius;
        return {where_negative(dot(m.step, m.step) - r2 * m.w1 * m.w1, dot(m.at0, m.step) - r2 * m.w0 * m.w1,
                    dot(m.at0, m.at0) - r2 * m.w0 * m.w0, m.sides),
            {}};
    }
    bool holds(Vec3d) const { return false; }

    Vec3d middle() const { return center; }
    double half_extent(Vec3d axis) const { return radius * disk_reach(axis, normal); }
    std::array<Vec3d, 1> faces() const { return {normal}; }
    Azimuths azimuths(Vec3d x, const Frame<double>& frame) const {
        const Frame<double> frame_of_disk = frame_about(normal);
        return azimuths_of_ellipse(center - x, radius * frame_of_disk.t, radius * frame_of_disk.b, frame);
    }

    /// Large: a is the point of the edge nearest to the origin, c the unit direction there from the centre, radius
    /// below 0.
    BodyNumbers numbers(Vec3d origin) const {
        const Vec3d a = center - origin;
        const double offset = dot(normal, a);
        if (radius < large_body) return {.a = a, .b = normal, .c = {}, .radius = radius, .offset = offset};
        const Vec3d to = offset * normal - a;  // from the centre to the origin's foot
        const double distance = std::sqrt(dot(to, to));
        const Vec3d out = distance > 0 ? (1 / distance) * to : frame_about(normal).t;
        return {.a = a + radius * out, .b = normal, .c = out, .radius = -radius, .offset = offset};
    }
    template <class F> static MaskOf<F> blocks(const PackedBody<F>& body, Vec3<F> o, Vec3<F> d, F lo, F hi) {
        const F t = plane_at(body.b, body.offset, o, d);
        const Vec3<F> p = o + d * t - body.a;
        const auto on_way = (t > lo) & (t < hi);
        if (any(body.radius < number<F>(0)))  // (p + r c)^2 <= r^2
            return on_way & (dot(p, p) <= number<F>(2) * body.radius * dot(body.c, p));
        return on_way & (dot(p, p) <= sqr(body.radius));
    }
};

}  // namespace crescent::shapes
