#include "scene/shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace crescent {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// v in `range` with a v^2 + 2 b v + c <= 0, known to be one interval there.
Interval where_negative(double a, double b, double c, Interval range) {
    if (range.empty()) return {};
    std::array<double, 4> cut = {range.lo, range.lo, range.hi, range.hi};
    const double discriminant = b * b - a * c;
    if (discriminant > 0) {
        const double q = -(b + std::copysign(std::sqrt(discriminant), b));  // Numerical Recipes (5.6.4): no cancellation
        double r0 = q / a, r1 = c / q;
        if (!(r0 < r1)) std::swap(r0, r1);
        if (r0 > range.lo && r0 < range.hi) cut[1] = r0;
        if (r1 > range.lo && r1 < range.hi) cut[2] = r1;
    }
    Interval out{range.hi, range.lo};
    for (std::size_t i = 0; i < 3; ++i) {
        const double middle = 0.5 * (cut[i] + cut[i + 1]);
        if (cut[i] < cut[i + 1] && (a * middle + 2 * b) * middle + c <= 0) out = {std::min(out.lo, cut[i]), std::max(out.hi, cut[i + 1])};
    }
    return out;
}

/// v in [0, 1] with p0 + v (p1 - p0) >= 0.
Interval where_positive(double p0, double p1) {
    if (p0 >= 0 && p1 >= 0) return {0, 1};
    if (p0 < 0 && p1 < 0) return {};
    const double root = p0 / (p0 - p1);
    return p0 < 0 ? Interval{root, 1} : Interval{0, root};
}

Interval both(Interval a, Interval b) { return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)}; }

/// The segment crosses the sphere: it comes within r of the centre between its ends. Outside points see the sphere's
/// cone, (d.c)^2 >= |d|^2 (|c|^2 - r^2) and d.c > 0, cut off where the chord itself is nearer than the sphere.
Interval sphere(const Occluder& o, Vec3d x, Vec3d y0, Vec3d y1) {
    const Vec3d c = o.a - x, d0 = y0 - x, e = y1 - y0;
    const double q = dot(c, c) - o.radius * o.radius;
    if (q <= 0) return {};
    const double a = q * dot(e, e) - sqr(dot(e, c));
    const double b = q * dot(d0, e) - dot(d0, c) * dot(e, c);
    const double k = q * dot(d0, d0) - sqr(dot(d0, c));
    // Inside the cone an end lies behind the first crossing where d.c >= q (the polar plane of x).
    return where_negative(a, b, k, where_positive(dot(d0, c) - q, dot(d0 + e, c) - q));
}

/// The chord's segments cross the parallelogram or disk in the plane through p with normal n.
struct OnPlane {
    Vec3d at0, step;  // where segment v meets the plane, homogeneous: (at0 + v step) / (w0 + v w1)
    double w0, w1;
    Interval sides;   // x and y(v) on different sides
};
OnPlane project(Vec3d p, Vec3d n, Vec3d x, Vec3d y0, Vec3d y1) {
    const double hx = dot(n, x - p), h0 = dot(n, y0 - p), h1 = dot(n, y1 - p);
    const double s = hx > 0 ? 1 : -1;
    // Crossing point = x + (y - x) hx / (hx - h), with hx - h linear in v: relative to p, times (hx - h).
    const Vec3d g0 = s * ((hx - h0) * (x - p) + hx * (y0 - x)), g1 = s * ((hx - h1) * (x - p) + hx * (y1 - x));
    return {g0, g1 - g0, s * (hx - h0), s * (h0 - h1), hx == 0 ? Interval{} : where_positive(-s * h0, -s * h1)};
}

Interval quad(const Occluder& o, Vec3d x, Vec3d y0, Vec3d y1) {
    const Vec3d n = cross(o.b, o.c);
    const OnPlane m = project(o.a, n, x, y0, y1);
    const auto inside = [&](Vec3d axis) {  // 0 <= axis . g <= w
        const double a0 = dot(axis, m.at0), a1 = dot(axis, m.at0 + m.step);
        return both(where_positive(a0, a1), where_positive(m.w0 - a0, m.w0 + m.w1 - a1));
    };
    const double nn = dot(n, n);
    return both(m.sides, both(inside(cross(o.c, n) * (1 / nn)), inside(cross(n, o.b) * (1 / nn))));
}

Interval disk(const Occluder& o, Vec3d x, Vec3d y0, Vec3d y1) {
    const OnPlane m = project(o.a, o.b, x, y0, y1);
    const double r2 = o.radius * o.radius;
    return where_negative(dot(m.step, m.step) - r2 * m.w1 * m.w1, dot(m.at0, m.step) - r2 * m.w0 * m.w1,
                          dot(m.at0, m.at0) - r2 * m.w0 * m.w0, m.sides);
}

/// The triangle (x, y0, y1) cut by the box: its points x + a (y0 - x) + b (y1 - x) inside the six half-spaces form a
/// convex polygon in (a, b); each of its corners is seen at v = b / (a + b).
Interval box(const Occluder& o, Vec3d x, Vec3d y0, Vec3d y1) {
    struct Corner {
        double a, b;
    };
    std::array<Corner, 16> polygon = {{{0, 0}, {1, 0}, {0, 1}}}, next;  // a triangle and at most one corner more a cut
    std::size_t size = 3;
    const auto cut = [&](double h0, double ha, double hb) {  // keep h0 + a ha + b hb >= 0
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const Corner p = polygon[i], q = polygon[i + 1 < size ? i + 1 : 0];
            const double hp = h0 + p.a * ha + p.b * hb, hq = h0 + q.a * ha + q.b * hb;
            if (hp >= 0) next[kept++] = p;
            if ((hp >= 0) != (hq >= 0)) {
                const double t = hp / (hp - hq);
                next[kept++] = {p.a + t * (q.a - p.a), p.b + t * (q.b - p.b)};
            }
        }
        polygon = next;
        size = kept;
    };
    const Vec3d d0 = y0 - x, d1 = y1 - x;
    cut(x.x - o.a.x, d0.x, d1.x), cut(o.b.x - x.x, -d0.x, -d1.x);
    cut(x.y - o.a.y, d0.y, d1.y), cut(o.b.y - x.y, -d0.y, -d1.y);
    cut(x.z - o.a.z, d0.z, d1.z), cut(o.b.z - x.z, -d0.z, -d1.z);
    Interval out{infinity, -infinity};
    for (std::size_t i = 0; i < size; ++i) {
        const Corner& c = polygon[i];
        if (!(c.a + c.b > 0)) return {};  // x itself lies in the box
        const double v = c.b / (c.a + c.b);
        out = {std::min(out.lo, v), std::max(out.hi, v)};
    }
    return out;
}

}  // namespace

Interval hidden(const Occluder& o, Vec3d x, Vec3d y0, Vec3d y1) {
    switch (o.kind) {
        case Occluder::Kind::sphere: return sphere(o, x, y0, y1);
        case Occluder::Kind::box: return box(o, x, y0, y1);
        case Occluder::Kind::quad: return quad(o, x, y0, y1);
        case Occluder::Kind::disk: return disk(o, x, y0, y1);
        case Occluder::Kind::plane: return project(o.a, o.b, x, y0, y1).sides;
    }
    return {};
}

}  // namespace crescent
