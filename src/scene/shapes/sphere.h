// sphere: all points at one distance from a centre.
#pragma once

#include <cmath>

#include "scene/body.h"

namespace crescent::shapes {

struct Sphere {
    static constexpr std::string_view name = "sphere";
    static constexpr std::string_view summary = "a ball";
    Vec3d center{};
    double radius = 0;

    static constexpr auto parameters() {
        return std::array{parameter::place("center", &Sphere::center, "Centre."),
            parameter::length("radius", &Sphere::radius, "Radius.")};
    }

    Intersection intersect(Vec3d x, Vec3d d) const {
        const Vec3d o = x - center;
        const double a = dot(d, d), b = dot(o, d), oo = dot(o, o), c = oo - radius * radius;
        const Vec3d offset = o - (b / a) * d;  // for a small sphere far away b^2 and a c agree in all digits
        const double discriminant = oo > 1e6 * sqr(radius) ? a * (sqr(radius) - dot(offset, offset)) : b * b - a * c;
        if (discriminant < 0) return {};
        const double root = std::sqrt(discriminant);
        for (double t : {(-b - root) / a, (-b + root) / a})
            if (t > 0) return crossing_at(t, normalize(o + t * d));
        return {};
    }

    /// The way passes within r of the centre. With p the point of a ray's own polar plane, at q / (d.c) of the way
    /// between both crossings, the sphere is met between the ends if the ray lies in the cone (d.c)^2 >= |d|^2 q and p
    /// is between the ends, or if an end is inside.
    std::array<Interval, 2> hidden(const Sight& s) const {
        const Vec3d c = center - s.x;
        const double q = dot(c, c) - radius * radius;
        const double ee = dot(s.step, s.step), de = dot(s.d0, s.step), dd = dot(s.d0, s.d0), ec = dot(s.step, c),
                     dc = dot(s.d0, c);
        const auto where_inside = [&](double f) {
            return where_negative(f * f * ee, f * (f * de - ec), f * (f * dd - 2 * dc) + q, {0, 1});
        };
        const Interval start = where_inside(s.limits.from), end = where_inside(s.limits.to);
        if (q <= 0) return Met{start, start, end}.crossed();
        const auto where_beyond = [&](double f, double sign) {
            return where_positive(sign * (f * dc - q), sign * (f * (dc + ec) - q));
        };
        const Interval cone = where_negative(q * ee - ec * ec, q * de - dc * ec, q * dd - dc * dc,
            both(where_beyond(s.limits.to, 1), where_beyond(s.limits.from, -1)));
        return Met{hull(cone, hull(start, end)), start, end}.crossed();
    }
    bool holds(Vec3d x) const { return dot(x - center, x - center) <= sqr(radius); }

    Vec3d middle() const { return center; }
    double half_extent(Vec3d axis) const { return radius * std::sqrt(dot(axis, axis)); }
    std::array<Vec3d, 0> faces() const { return {}; }
    Azimuths azimuths(Vec3d x, const Frame<double>& frame) const { return azimuths_of_ball(center - x, radius, frame); }

    /// Large or far: a is its point nearest to the origin, b its normal there, offset its curvature 1 / r. Else a is
    /// the centre, and the curvature is unused.
    BodyNumbers numbers(Vec3d origin) const {
        const Vec3d c = center - origin;
        const double distance = std::sqrt(dot(c, c));
        if (sqr(distance) < large_body * radius && radius < large_body)
            return {.a = c, .b = {}, .c = {}, .radius = radius, .offset = 0};
        const Vec3d n = distance > 0 ? (-1 / distance) * c : Vec3d{0, 1, 0};
        return {.a = c + radius * n, .b = n, .c = {}, .radius = radius, .offset = 1 / radius};
    }
    template <class F> static MaskOf<F> blocks(const PackedBody<F>& body, Vec3<F> o, Vec3<F> d, F lo, F hi) {
        const F zero = number<F>(0);
        if (any(body.offset > zero)) return blocks_far(body, o, d, lo, hi);
        const Vec3<F> c = body.a - o;
        const F projection = dot(c, d);
        const F disc = sqr(projection) - (dot(c, c) - sqr(body.radius));
        const F root = sqrt(larger(disc, zero));
        return (disc > zero) & (within(projection - root, lo, hi) | within(projection + root, lo, hi));
    }

private:
    /// With v from a to o and k = 1 / r the ray meets it where k t^2 + 2 (n.d + k v.d) t + k v^2 + 2 n.v = 0. It
    /// contains neither r^2 nor the distance to the centre, and the discriminant is computed from the components across
    /// the ray, as in Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems,
    /// chapter 7.
    template <class F> static MaskOf<F> blocks_far(const PackedBody<F>& body, Vec3<F> o, Vec3<F> d, F lo, F hi) {
        const F zero = number<F>(0), two = number<F>(2), k = body.offset;
        const Vec3<F> v = o - body.a, offset = v - d * dot(v, d);
        const F nd = dot(body.b, d), b = nd + k * dot(v, d);
        const F disc = sqr(nd) - k * (two * dot(body.b, offset) + k * dot(offset, offset));
        const F root = sqrt(larger(disc, zero));
        const F sum = select(b > zero, -(b + root), root - b);  // avoids cancellation
        const F nearest = (k * dot(v, v) + two * dot(body.b, v)) / select(sum == zero, number<F>(1e-30), sum);
        return (disc > zero) & (within(nearest, lo, hi) | within(sum * body.radius, lo, hi));
    }
};

}  // namespace crescent::shapes
