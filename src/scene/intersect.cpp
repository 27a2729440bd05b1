#include "scene/intersect.h"

#include <cmath>

namespace crescent {

namespace {

constexpr double none = std::numeric_limits<double>::infinity();

Crossing at(double t, Vec3d n) { return {t, t, n, false}; }

Crossing sphere(const Shape& q, Vec3d x, Vec3d d) {
    const Vec3d o = x - q.center;
    const double a = dot(d, d), b = dot(o, d), c = dot(o, o) - q.radius * q.radius;
    const double discriminant = b * b - a * c;
    if (discriminant < 0) return {};
    const double root = std::sqrt(discriminant);
    for (double t : {(-b - root) / a, (-b + root) / a})
        if (t > 0) return at(t, normalize(o + t * d));
    return {};
}

Crossing box(const Shape& q, Vec3d x, Vec3d d) {
    double near = -none, far = none;
    Vec3d near_n{}, far_n{};
    const auto slab = [&](double lo, double hi, double o, double v, Vec3d axis) {
        if (v == 0) {
            if (o < lo || o > hi) near = none;
            return;
        }
        double t0 = (lo - o) / v, t1 = (hi - o) / v;
        if (t0 > t1) std::swap(t0, t1);
        if (t0 > near) near = t0, near_n = axis;
        if (t1 < far) far = t1, far_n = axis;
    };
    slab(q.min.x, q.max.x, x.x, d.x, {1, 0, 0});
    slab(q.min.y, q.max.y, x.y, d.y, {0, 1, 0});
    slab(q.min.z, q.max.z, x.z, d.z, {0, 0, 1});
    if (near > far || far <= 0) return {};
    return near > 0 ? at(near, near_n) : at(far, far_n);
}

double plane_t(Vec3d point, Vec3d n, Vec3d x, Vec3d d) {
    const double v = dot(n, d);
    const double t = v == 0 ? none : dot(n, point - x) / v;
    return t > 0 ? t : none;
}

/// t where the ray meets the parallelogram corner + a u + b v, 0 <= a, b <= 1.
double parallelogram_t(Vec3d corner, Vec3d u, Vec3d v, Vec3d x, Vec3d d) {
    const Vec3d w = cross(u, v);
    const double t = plane_t(corner, w, x, d);
    if (t == none) return none;
    const Vec3d p = x + t * d - corner;
    const double a = dot(cross(p, v), w) / dot(w, w), b = dot(cross(u, p), w) / dot(w, w);
    return a >= 0 && a <= 1 && b >= 0 && b <= 1 ? t : none;
}

/// A recess: through the opening, then the back or one of the four sides.
Crossing panel(const Shape& q, Vec3d x, Vec3d d) {
    const Vec3d n = quad_normal(q);
    const double opening = parallelogram_t(q.corner, q.edge_u, q.edge_v, x, d);
    if (opening == none || dot(n, d) >= 0) return {};
    const Vec3d down = -q.depth * n;
    Crossing best = at(parallelogram_t(q.corner + down, q.edge_u, q.edge_v, x, d), n);
    const auto side = [&](Vec3d corner, Vec3d edge) {
        const double t = parallelogram_t(corner, edge, down, x, d);
        if (t >= opening && t < best.t) best = {t, t, normalize(cross(edge, down)), true};
    };
    side(q.corner, q.edge_u);
    side(q.corner, q.edge_v);
    side(q.corner + q.edge_v, q.edge_u);
    side(q.corner + q.edge_u, q.edge_v);
    best.order = opening * (1 - 1e-9);  // before the surface it is let into
    return best;
}

}  // namespace

Crossing intersect(const Shape& q, Vec3d x, Vec3d d) {
    switch (q.kind) {
        case ShapeKind::sphere: return sphere(q, x, d);
        case ShapeKind::box: return box(q, x, d);
        case ShapeKind::quad: return at(parallelogram_t(q.corner, q.edge_u, q.edge_v, x, d), quad_normal(q));
        case ShapeKind::plane: return at(plane_t(q.point, q.normal, x, d), q.normal);
        case ShapeKind::disk: {
            const double t = plane_t(q.center, q.normal, x, d);
            if (t == none) return {};
            const Vec3d p = x + t * d - q.center;
            return dot(p, p) <= q.radius * q.radius ? at(t, q.normal) : Crossing{};
        }
        case ShapeKind::panel: return panel(q, x, d);
    }
    return {};
}

}  // namespace crescent
