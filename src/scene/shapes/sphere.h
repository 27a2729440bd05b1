// sphere: all points at one distance from a centre.
#pragma once

#include <cmath>

#include "scene/body.h"

namespace crescent::shapes {

struct Sphere {
    static constexpr std::string_view name = "sphere";
    Vec3d center{};
    double radius = 0;

    static constexpr auto parameters() {
        return std::array{parameter::place("center", &Sphere::center, "Centre."),
            parameter::length("radius", &Sphere::radius, "Radius.")};
    }

    Intersection intersect(Vec3d x, Vec3d d) const {
        const Vec3d o = x - center;
        const double a = dot(d, d), b = dot(o, d), c = dot(o, o) - radius * radius;
        const double discriminant = b * b - a * c;
        if (discriminant < 0) return {};
        const double root = std::sqrt(discriminant);
        for (double t : {(-b - root) / a, (-b + root) / a})
            if (t > 0) return crossing_at(t, normalize(o + t * d));
        return {};
    }

    /// The way passes within r of the centre. With p the point of a ray's own polar plane, at q / (d.c) of the way
    /// between both crossings, the sphere is met between the ends where the ray lies in the cone (d.c)^2 >= |d|^2 q and
    /// p does, or where an end is inside.
    std::array<Interval, 2> hidden(const Sight& s) const {
        const Vec3d c = center - s.x;
        const double q = dot(c, c) - radius * radius;
        const double ee = dot(s.step, s.step), de = dot(s.d0, s.step), dd = dot(s.d0, s.d0), ec = dot(s.step, c),
                     dc = dot(s.d0, c);
        const auto inside = [&](double f) {
            return where_negative(f * f * ee, f * (f * de - ec), f * (f * dd - 2 * dc) + q, {0, 1});
        };
        const Interval start = inside(s.between.from), end = inside(s.between.to);
        if (q <= 0) return Met{start, start, end}.crossed();
        const auto past = [&](double f, double sign) {
            return where_positive(sign * (f * dc - q), sign * (f * (dc + ec) - q));
        };
        const Interval cone = where_negative(q * ee - ec * ec, q * de - dc * ec, q * dd - dc * dc,
            both(past(s.between.to, 1), past(s.between.from, -1)));
        return Met{hull(cone, hull(start, end)), start, end}.crossed();
    }
    bool holds(Vec3d x) const { return dot(x - center, x - center) <= sqr(radius); }

    Vec3d middle() const { return center; }
    double half_extent(Vec3d axis) const { return radius * std::sqrt(dot(axis, axis)); }
    std::array<Vec3d, 0> faces() const { return {}; }
    Azimuths azimuths(Vec3d x, const Frame<double>& frame) const { return azimuths_of_ball(center - x, radius, frame); }

    BodyNumbers numbers(Vec3d origin) const { return {center - origin, {}, {}, radius, 0}; }
    template <class F> static MaskOf<F> blocks(const PackedBody<F>& body, Vec3<F> o, Vec3<F> d, F lo, F hi) {
        const F zero = number<F>(0);
        const Vec3<F> c = body.a - o;
        const F along = dot(c, d);
        const F disc = sqr(along) - (dot(c, c) - sqr(body.radius));
        const F root = sqrt(larger(disc, zero));
        return (disc > zero) & (within(along - root, lo, hi) | within(along + root, lo, hi));
    }
};

}  // namespace crescent::shapes
