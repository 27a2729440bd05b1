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
        const double q =
            -(b + std::copysign(std::sqrt(discriminant), b));  // Numerical Recipes (5.6.4): no cancellation
        double r0 = q / a, r1 = c / q;
        if (!(r0 < r1)) std::swap(r0, r1);
        if (r0 > range.lo && r0 < range.hi) cut[1] = r0;
        if (r1 > range.lo && r1 < range.hi) cut[2] = r1;
    }
    Interval out{range.hi, range.lo};
    for (std::size_t i = 0; i < 3; ++i) {
        const double middle = 0.5 * (cut[i] + cut[i + 1]);
        if (cut[i] < cut[i + 1] && (a * middle + 2 * b) * middle + c <= 0)
            out = {std::min(out.lo, cut[i]), std::max(out.hi, cut[i + 1])};
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

Interval hull(Interval a, Interval b) {
    return a.empty() ? b : b.empty() ? a : Interval{std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

/// A point, and the chord as seen from it.
struct Sight {
    Vec3d x, d0, step;  // d(v) = y(v) - x = d0 + v step
    Between between;
};

/// Of a convex solid: the v whose way meets it, and those whose way begins or ends in it.
struct Met {
    Interval way, start, end;
    /// Its surface is crossed where the way meets it, unless it runs inside from start to end.
    std::array<Interval, 2> crossed() const {
        const Interval inside = both(start, end);
        if (inside.empty()) return {way, {}};
        return {Interval{way.lo, inside.lo}, Interval{inside.hi, way.hi}};
    }
};

/// The way passes within r of the centre. With p the point of a ray's own polar plane, at q / (d.c) of the way between
/// both crossings, the sphere is met between the ends where the ray lies in the cone (d.c)^2 >= |d|^2 q and p does, or
/// where an end is inside.
Met sphere(const Occluder& o, const Sight& s) {
    const Vec3d c = o.a - s.x;
    const double q = dot(c, c) - o.radius * o.radius;
    const double ee = dot(s.step, s.step), de = dot(s.d0, s.step), dd = dot(s.d0, s.d0), ec = dot(s.step, c),
                 dc = dot(s.d0, c);
    const auto inside = [&](double f) {
        return where_negative(f * f * ee, f * (f * de - ec), f * (f * dd - 2 * dc) + q, {0, 1});
    };
    const Interval start = inside(s.between.from), end = inside(s.between.to);
    if (q <= 0) return {start, start, end};
    const auto past = [&](double f, double sign) {
        return where_positive(sign * (f * dc - q), sign * (f * (dc + ec) - q));
    };
    const Interval cone = where_negative(
        q * ee - ec * ec, q * de - dc * ec, q * dd - dc * dc, both(past(s.between.to, 1), past(s.between.from, -1)));
    return {hull(cone, hull(start, end)), start, end};
}

/// The chord's ways cross the parallelogram or disk in the plane through p with normal n.
struct OnPlane {
    Vec3d at0, step;  // where way v meets the plane, homogeneous: (at0 + v step) / (w0 + v w1)
    double w0, w1;
    Interval sides;  // start and end lie on different sides
};
OnPlane project(Vec3d p, Vec3d n, const Sight& s) {
    const double hx = dot(n, s.x - p), h0 = dot(n, s.d0),
                 h1 = h0 + dot(n, s.step);  // height of x; rise along the chord's ends
    const double sign = hx > 0 ? 1 : -1;
    // Crossing point = x - d hx / (n.d): relative to p, times -n.d, which is linear in v.
    const Vec3d g0 = sign * (-h0 * (s.x - p) + hx * s.d0), g1 = sign * (-h1 * (s.x - p) + hx * (s.d0 + s.step));
    const auto beyond = [&](double f, double side) {
        return where_positive(side * sign * (hx + f * h0), side * sign * (hx + f * h1));
    };
    return {g0, g1 - g0, -sign * h0, sign * (h0 - h1),
        hx == 0 ? Interval{} : both(beyond(s.between.from, 1), beyond(s.between.to, -1))};
}

Interval quad(const Occluder& o, const Sight& s) {
    const Vec3d n = cross(o.b, o.c);
    const OnPlane m = project(o.a, n, s);
    const auto inside = [&](Vec3d axis) {  // 0 <= axis . g <= w
        const double a0 = dot(axis, m.at0), a1 = dot(axis, m.at0 + m.step);
        return both(where_positive(a0, a1), where_positive(m.w0 - a0, m.w0 + m.w1 - a1));
    };
    const double nn = dot(n, n);
    return both(m.sides, both(inside(cross(o.c, n) * (1 / nn)), inside(cross(n, o.b) * (1 / nn))));
}

Interval disk(const Occluder& o, const Sight& s) {
    const OnPlane m = project(o.a, o.b, s);
    const double r2 = o.radius * o.radius;
    return where_negative(dot(m.step, m.step) - r2 * m.w1 * m.w1, dot(m.at0, m.step) - r2 * m.w0 * m.w1,
        dot(m.at0, m.at0) - r2 * m.w0 * m.w0, m.sides);
}

/// The strip between the ways' starts and ends, cut by the box: its points x + a d(0) + b d(1), a + b in `between`,
/// inside the six half-spaces form a convex polygon in (a, b); each of its corners is seen at v = b / (a + b).
Met box(const Occluder& o, const Sight& s) {
    struct Corner {
        double a, b;
    };
    const auto [from, to] = s.between;
    std::array<Corner, 16> polygon = {{{from, 0}, {to, 0}, {0, to}, {0, from}}},
                           next;  // and at most one corner more a cut
    std::size_t size = 4;
    Interval start{0, 1}, end{0, 1};
    const auto cut = [&](double h, double h0, double h1) {  // keep h + a h0 + b h1 >= 0
        start = both(start, where_positive(h + from * h0, h + from * h1));
        end = both(end, where_positive(h + to * h0, h + to * h1));
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const Corner p = polygon[i], q = polygon[i + 1 < size ? i + 1 : 0];
            const double hp = h + p.a * h0 + p.b * h1, hq = h + q.a * h0 + q.b * h1;
            if (hp >= 0) next[kept++] = p;
            if ((hp >= 0) != (hq >= 0)) {
                const double t = hp / (hp - hq);
                next[kept++] = {p.a + t * (q.a - p.a), p.b + t * (q.b - p.b)};
            }
        }
        polygon = next;
        size = kept;
    };
    const Vec3d x = s.x, d0 = s.d0, d1 = s.d0 + s.step;
    cut(x.x - o.a.x, d0.x, d1.x), cut(o.b.x - x.x, -d0.x, -d1.x);
    cut(x.y - o.a.y, d0.y, d1.y), cut(o.b.y - x.y, -d0.y, -d1.y);
    cut(x.z - o.a.z, d0.z, d1.z), cut(o.b.z - x.z, -d0.z, -d1.z);
    Interval way{infinity, -infinity};
    for (std::size_t i = 0; i < size; ++i) {
        const double v = polygon[i].b / (polygon[i].a + polygon[i].b);
        way = {std::min(way.lo, v), std::max(way.hi, v)};
    }
    return {way, start, end};
}

}  // namespace

std::array<Interval, 2> hidden(const Occluder& o, Vec3d x, Vec3d y0, Vec3d y1, Between between) {
    const Sight sight = {x, y0 - x, y1 - y0, between};
    switch (o.kind) {
        case Occluder::Kind::sphere: return sphere(o, sight).crossed();
        case Occluder::Kind::box: return box(o, sight).crossed();
        case Occluder::Kind::quad: return {quad(o, sight), {}};
        case Occluder::Kind::disk: return {disk(o, sight), {}};
        case Occluder::Kind::plane: return {project(o.a, o.b, sight).sides, {}};
    }
    return {};
}

bool holds(const Occluder& o, Vec3d x) {
    if (o.kind == Occluder::Kind::sphere) return dot(x - o.a, x - o.a) <= sqr(o.radius);
    if (o.kind != Occluder::Kind::box) return false;
    return x.x >= o.a.x && x.x <= o.b.x && x.y >= o.a.y && x.y <= o.b.y && x.z >= o.a.z && x.z <= o.b.z;
}

}  // namespace crescent
