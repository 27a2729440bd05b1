// triangle: from a corner along two edges; its outward normal is edge_u x edge_v.
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/shapes/quad.h"

namespace crescent::shapes {

struct Triangle {
    static constexpr std::string_view name = "triangle";
    static constexpr std::string_view summary = "a triangle, from a corner along two edges";
    Vec3d corner{}, edge_u{}, edge_v{};

    static constexpr auto parameters() {
        return std::array{parameter::place("corner", &Triangle::corner, "A corner."),
            parameter::place("edge_u", &Triangle::edge_u, "First edge from the corner."),
            parameter::place("edge_v", &Triangle::edge_v, "Second edge; it faces along edge_u x edge_v.")};
    }
    std::optional<Mistake> mistake() const { return mistake_of_edges(edge_u, edge_v); }

    Intersection intersect(Vec3d x, Vec3d d) const {
        const Vec3d n = cross(edge_u, edge_v);
        const double t = plane_t(corner, n, x, d);
        if (t == never) return {};
        const Vec3d p = x + t * d - corner;
        const double a = dot(cross(p, edge_v), n), b = dot(cross(edge_u, p), n);
        return a >= 0 && b >= 0 && a + b <= dot(n, n) ? crossing_at(t, normalize(n)) : Intersection{};
    }

    std::array<Interval, 2> hidden(const Sight& s) const {
        const Vec3d n = cross(edge_u, edge_v);
        const OnPlane m = project(corner, n, s);
        const Vec3d u = cross(edge_v, n) * (1 / dot(n, n)), v = cross(n, edge_u) * (1 / dot(n, n));
        const auto positive = [&](Vec3d axis, double one) {  // one w + axis . g >= 0
            return where_positive(one * m.w0 + dot(axis, m.at0), one * (m.w0 + m.w1) + dot(axis, m.at0 + m.step));
        };
        return {both(m.sides, both(positive(u, 0), both(positive(v, 0), positive(-u - v, 1)))), {}};
    }
    bool holds(Vec3d) const { return false; }

    Vec3d middle() const { return corner + (edge_u + edge_v) * (1.0 / 3); }
    double half_extent(Vec3d axis) const {
        const double m = dot(axis, middle()), a = dot(axis, corner);
        return std::max({std::fabs(a - m), std::fabs(a + dot(axis, edge_u) - m), std::fabs(a + dot(axis, edge_v) - m)});
    }
    std::array<Vec3d, 1> faces() const { return {cross(edge_u, edge_v)}; }
    std::array<Vec3d, 3> corners() const { return {corner, corner + edge_u, corner + edge_v}; }
    Azimuths azimuths(Vec3d x, const Frame<double>& frame) const { return azimuths_of_corners(corners(), x, frame); }

    BodyNumbers numbers(Vec3d origin) const {
        return {corner - origin, edge_u, edge_v, 0, dot(cross(edge_u, edge_v), corner - origin)};
    }
    template <class F> static MaskOf<F> blocks(const PackedBody<F>& body, Vec3<F> o, Vec3<F> d, F lo, F hi) {
        const F zero = number<F>(0);
        const Vec3<F> n = cross(body.b, body.c);
        const F t = plane_at(n, body.offset, o, d);
        const Vec3<F> p = o + d * t - body.a;
        const F x = dot(cross(p, body.c), n), y = dot(cross(body.b, p), n);
        return within(t, lo, hi) & (x >= zero) & (y >= zero) & (x + y <= dot(n, n));
    }
};

}  // namespace crescent::shapes
