// A body's shadow on the plane across the axis is an ellipse or a polygon; its azimuths are those of the two tangents
// from the origin. Those of an ellipse are the roots of a quadratic form, in closed form. Radians.
#include "scene/body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/functions.h"

namespace crescent {

namespace {

/// A point or a vector in the plane across the axis.
struct Flat {
    double x, y;
};
Flat flat(Vec3d v, const Frame<double>& frame) { return {dot(v, frame.t), dot(v, frame.b)}; }
double cross(Flat a, Flat b) { return a.x * b.y - a.y * b.x; }
double dot(Flat a, Flat b) { return a.x * b.x + a.y * b.y; }

/// A line along (cos phi, sin phi) meets the ellipse where k = (-sin phi, cos phi) has (k.p)^2 <= (k.u)^2 + (k.v)^2, a
/// quadratic form m - a cos 2(phi - middle) in k.
Azimuths of_ellipse(Flat p, Flat u, Flat v) {
    const double discriminant = sqr(cross(p, u)) + sqr(cross(p, v)) - sqr(cross(u, v));  // -det of the form = a^2 - m^2
    const double xx = p.x * p.x - u.x * u.x - v.x * v.x, yy = p.y * p.y - u.y * u.y - v.y * v.y,
                 xy = p.x * p.y - u.x * u.y - v.x * v.y;
    if (!(discriminant > 0)) return {};
    const double middle = 0.5 * math::atan2(2 * xy, xx - yy),
                 half = 0.5 * math::atan2(std::sqrt(discriminant), 0.5 * (xx + yy));
    const auto [sin, cos] = math::sincos(middle);
    const bool is_ahead = dot(p, {cos, sin}) > 0;
    return {is_ahead ? middle : middle + pi, half};
}

}  // namespace

bool Azimuths::meet(double lo, double hi) const {
    const double distance = std::remainder(0.5 * (lo + hi) - middle, 2 * pi);
    return std::fabs(distance) <= half + 0.5 * (hi - lo);
}

Azimuths azimuths_of_ellipse(Vec3d p, Vec3d u, Vec3d v, const Frame<double>& frame) {
    return of_ellipse(flat(p, frame), flat(u, frame), flat(v, frame));
}

Azimuths azimuths_of_ball(Vec3d p, double radius, const Frame<double>& frame) {
    return of_ellipse(flat(p, frame), {radius, 0}, {0, radius});
}

Azimuths azimuths_of_corners(std::span<const Vec3d> points, Vec3d x, const Frame<double>& frame) {
    std::array<Flat, 8> corners;
    for (std::size_t k = 0; k < points.size(); ++k) corners[k] = flat(points[k] - x, frame);
    Flat middle = {0, 0};
    for (std::size_t k = 0; k < points.size(); ++k) {
        middle.x += corners[k].x;
        middle.y += corners[k].y;
    }
    if (middle.x == 0 && middle.y == 0) return {};  // the axis meets their hull, and the azimuth is undefined
    double lo = pi, hi = -pi;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const double angle = math::atan2(cross(middle, corners[k]), dot(middle, corners[k]));
        lo = std::min(lo, angle);
        hi = std::max(hi, angle);
    }
    if (!(hi - lo < pi)) return {};
    return {math::atan2(middle.y, middle.x) + 0.5 * (lo + hi), 0.5 * (hi - lo)};
}

}  // namespace crescent
