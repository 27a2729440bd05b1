// quad: a parallelogram, from a corner along two edges; its outward normal is edge_u x edge_v.
#pragma once

#include <cmath>
#include <optional>

#include "scene/body.h"

namespace crescent::shapes {

/// Returns an error if two edges span no area.
inline std::optional<Mistake> mistake_of_edges(Vec3d u, Vec3d v) {
    constexpr double parallel = 1e-6;  // sine of the angle under which two directions count as one
    const double size_u = std::sqrt(dot(u, u)), size_v = std::sqrt(dot(v, v));
    const Vec3d n = cross(u, v);
    if (!(size_u > 0)) return Mistake{"edge_u", "expected an edge with a length, found the zero vector"};
    if (!(size_v > 0)) return Mistake{"edge_v", "expected an edge with a length, found the zero vector"};
    if (std::sqrt(dot(n, n)) < parallel * size_u * size_v)
        return Mistake{"edge_v", "expected an edge that is not parallel to edge_u"};
    return {};
}

struct Quad {
    static constexpr std::string_view name = "quad";
    static constexpr std::string_view summary = "a parallelogram, from a corner along two edges";
    Vec3d corner{}, edge_u{}, edge_v{};

    static constexpr auto parameters() {
        return std::array{parameter::place("corner", &Quad::corner, "A corner of the quad, or of the panel's opening."),
            parameter::place("edge_u", &Quad::edge_u, "First edge from the corner."),
            parameter::place("edge_v", &Quad::edge_v, "Second edge; it faces along edge_u x edge_v.")};
    }
    std::optional<Mistake> mistake() const { return mistake_of_edges(edge_u, edge_v); }

    Intersection intersect(Vec3d x, Vec3d d) const {
        return crossing_at(parallelogram_t(corner, edge_u, edge_v, x, d), normalize(cross(edge_u, edge_v)));
    }

    std::array<Interval, 2> hidden(const Sight& s) const {
        const Vec3d n = cross(edge_u, edge_v);
        const OnPlane m = project(corner, n, s);
        const auto where_inside = [&](Vec3d axis) {  // 0 <= axis . g <= w
            const double a0 = dot(axis, m.at0), a1 = dot(axis, m.at0 + m.step);
            return both(where_positive(a0, a1), where_positive(m.w0 - a0, m.w0 + m.w1 - a1));
        };
        const double nn = dot(n, n);
        return {
            both(m.sides, both(where_inside(cross(edge_v, n) * (1 / nn)), where_inside(cross(n, edge_u) * (1 / nn)))),
            {}};
    }
    bool holds(Vec3d) const { return false; }

    Vec3d middle() const { return corner + 0.5 * (edge_u + edge_v); }
    double half_extent(Vec3d axis) const { return 0.5 * (std::fabs(dot(axis, edge_u)) + std::fabs(dot(axis, edge_v))); }
    std::array<Vec3d, 3> faces() const { return {cross(edge_u, edge_v), edge_u, edge_v}; }
    std::array<Vec3d, 4> corners() const {
        return {corner, corner + edge_u, corner + edge_v, corner + edge_u + edge_v};
    }
    Azimuths azimuths(Vec3d x, const Frame<double>& frame) const { return azimuths_of_corners(corners(), x, frame); }

    /// Large: a point p of its plane has the coordinates x = a.x + b.p and y = a.y + c.p along the edges, from the
    /// corner whose coordinates are nearest to the origin's; the radius is 1. Else a, b and c are corner and edges.
    BodyNumbers numbers(Vec3d origin) const {
        const Vec3d a = corner - origin, n = cross(edge_u, edge_v);
        if (dot(edge_u, edge_u) < sqr(large_body) && dot(edge_v, edge_v) < sqr(large_body))
            return {.a = a, .b = edge_u, .c = edge_v, .radius = 0, .offset = dot(n, a)};
        const double nn = dot(n, n);
        Vec3d b = (1 / nn) * cross(edge_v, n), c = (1 / nn) * cross(n, edge_u);
        double x = -dot(b, a), y = -dot(c, a);
        if (x > 0.5) {
            b = -b;
            x = 1 - x;
        }
        if (y > 0.5) {
            c = -c;
            y = 1 - y;
        }
        return {.a = {x, y, 0}, .b = b, .c = c, .radius = 1, .offset = dot(cross(b, c), a)};
    }
    template <class F> static MaskOf<F> blocks(const PackedBody<F>& body, Vec3<F> o, Vec3<F> d, F lo, F hi) {
        const F zero = number<F>(0);
        const Vec3<F> n = cross(body.b, body.c);
        const F t = plane_at(n, body.offset, o, d);
        if (any(body.radius > zero)) {
            const Vec3<F> point = o + d * t;
            const F u = body.a.x + dot(body.b, point), v = body.a.y + dot(body.c, point), one = number<F>(1);
            return (t > lo) & (t < hi) & (u >= zero) & (u <= one) & (v >= zero) & (v <= one);
        }
        const Vec3<F> p = o + d * t - body.a;
        const F nn = dot(n, n), x = dot(cross(p, body.c), n), y = dot(cross(body.b, p), n);
        return (t > lo) & (t < hi) & (x >= zero) & (x <= nn) & (y >= zero) & (y <= nn);
    }
};

}  // namespace crescent::shapes
