#include "estimator/azimuth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "math/functions.h"

namespace crescent {

namespace {

/// A point or an arrow in the plane across the axis.
struct Flat {
    double x, y;
};
Flat flat(Vec3d v, const Frame<double>& frame) { return {dot(v, frame.t), dot(v, frame.b)}; }
double cross(Flat a, Flat b) { return a.x * b.y - a.y * b.x; }
double dot(Flat a, Flat b) { return a.x * b.x + a.y * b.y; }

/// An ellipse about p with conjugate half-axes u and v, seen from the origin. A line along (cos phi, sin phi) meets it
/// where k = (-sin phi, cos phi) has (k.p)^2 <= (k.u)^2 + (k.v)^2, a quadratic form m - a cos 2(phi - middle) in k.
Azimuths of_ellipse(Flat p, Flat u, Flat v) {
    const double outside = sqr(cross(p, u)) + sqr(cross(p, v)) - sqr(cross(u, v));  // -det of the form = a^2 - m^2
    const double xx = p.x * p.x - u.x * u.x - v.x * v.x, yy = p.y * p.y - u.y * u.y - v.y * v.y,
                 xy = p.x * p.y - u.x * u.y - v.x * v.y;
    if (!(outside > 0)) return {};
    const double middle = 0.5 * math::atan2(2 * xy, xx - yy),
                 half = 0.5 * math::atan2(std::sqrt(outside), 0.5 * (xx + yy));
    const bool ahead = dot(p, {math::cos(middle), math::sin(middle)}) > 0;
    return {ahead ? middle : middle + pi, half};
}

Azimuths of_corners(std::span<const Flat> corners) {
    Flat middle = {0, 0};
    for (const Flat& c : corners) middle.x += c.x, middle.y += c.y;
    double lo = pi, hi = -pi;
    for (const Flat& c : corners) {
        const double off = math::atan2(cross(middle, c), dot(middle, c));
        lo = std::min(lo, off), hi = std::max(hi, off);
    }
    if (!(hi - lo < pi)) return {};
    return {math::atan2(middle.y, middle.x) + 0.5 * (lo + hi), 0.5 * (hi - lo)};
}

}  // namespace

bool Azimuths::meet(double lo, double hi) const {
    const double off = std::remainder(0.5 * (lo + hi) - middle, 2 * pi);
    return std::fabs(off) <= half + 0.5 * (hi - lo);
}

Azimuths azimuths_of(const Occluder& o, Vec3d x, const Frame<double>& frame) {
    const auto at = [&](Vec3d y) { return flat(y - x, frame); };
    switch (o.kind) {
        case Occluder::Kind::sphere: return of_ellipse(at(o.a), {o.radius, 0}, {0, o.radius});
        case Occluder::Kind::disk: {
            const Frame<double> own = frame_about(o.b);
            return of_ellipse(at(o.a), flat(o.radius * own.t, frame), flat(o.radius * own.b, frame));
        }
        case Occluder::Kind::quad:
            return of_corners(std::array{at(o.a), at(o.a + o.b), at(o.a + o.c), at(o.a + o.b + o.c)});
        case Occluder::Kind::box: {
            std::array<Flat, 8> corners;
            for (unsigned k = 0; k < 8; ++k)
                corners[k] = at({k & 1 ? o.b.x : o.a.x, k & 2 ? o.b.y : o.a.y, k & 4 ? o.b.z : o.a.z});
            return of_corners(corners);
        }
        case Occluder::Kind::plane: return {};
    }
    return {};
}

}  // namespace crescent
