// A half-plane from the axis through the point cuts the light's figure in a segment. Along it the angle al from the
// axis rises; Lambert's part has a closed form in al, with a series where it would cancel.
#include "reference/fan.h"

#include <algorithm>
#include <cmath>

namespace crescent::inline reference {

namespace {

/// al - sin(al) cos(al), its series where the difference would cancel.
double sector(const Direction& d) {
    if (d.al > 0.3) return d.al - d.sin * d.cos;
    const double x = d.al * d.al;
    return d.al * x *
        (2.0 / 3 - x * (2.0 / 15 - x * (4.0 / 315 - x * (2.0 / 2835 - x * (4.0 / 155925 - x * (4.0 / 6081075))))));
}

}  // namespace

Fan::Fan(const DiskPoint& point, const Figure& light, const Frame<double>& about, const math::SinCos& azimuth)
    : axis(about.n), aside(azimuth.cos * about.t + azimuth.sin * about.b) {
    const Vec3d k = cross(axis, aside);
    const std::optional<Line> line = std::visit(
        [&](const auto& figure) {
            if constexpr (requires { figure.center; }) return cut(figure, figure.center - point.x, k);
            else return cut(figure, figure.corner - point.x, k);
        },
        light);
    if (!line) return;
    Vec3d from = line->from, to = line->to;
    const double side0 = dot(aside, from), side1 = dot(aside, to);
    if (side0 <= 0 && side1 <= 0) return;
    const Vec3d end = from + (side0 / (side0 - side1)) * (to - from);  // where the half-plane ends
    if (side0 < 0) from = end;
    if (side1 < 0) to = end;
    if (dot(cross(from, to), k) < 0) std::swap(from, to);  // al rises
    to0 = from, step = to - from, empty = false;
}

Direction Fan::at(double v) const {
    const Vec3d d = to0 + v * step;
    const double sin = std::max(0.0, dot(d, aside)), cos = dot(d, axis), size = 1 / std::sqrt(sin * sin + cos * cos);
    return {sin * size, cos * size, math::atan2(sin, cos)};
}

void Fan::rise_above(const DiskPoint& point, Direction& from, Direction& to) const {  // cos(al - top) > 0
    const double along = dot(point.frame.n, axis), across = dot(point.frame.n, aside),
                 size = std::sqrt(along * along + across * across);
    double top = math::atan2(across, along);
    if (top < -pi / 2) top += 2 * pi;
    if (from.al < top - pi / 2) from = {-along / size, across / size, top - pi / 2};
    if (to.al > top + pi / 2) to = {along / size, -across / size, top + pi / 2};
}

double Fan::lambert(const DiskPoint& point, const Direction& from, const Direction& to) const {
    const double along = 0.5 * (to.sin + from.sin) * (to.sin - from.sin), across = 0.5 * (sector(to) - sector(from));
    return dot(point.frame.n, axis) * along + dot(point.frame.n, aside) * across;
}

}  // namespace crescent::inline reference
