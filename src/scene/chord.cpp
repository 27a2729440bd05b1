#include "scene/chord.h"

#include <algorithm>
#include <cmath>

namespace crescent::inline scene {

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

std::array<Interval, 2> Met::crossed() const {
    const Interval inside = both(start, end);
    if (inside.empty()) return {way, {}};
    return {Interval{way.lo, inside.lo}, Interval{inside.hi, way.hi}};
}

OnPlane project(Vec3d p, Vec3d n, const Sight& s) {
    const double hx = dot(n, s.x - p), h0 = dot(n, s.d0),
                 h1 = h0 + dot(n, s.step);  // height of x; rise along the chord's ends
    const double sign = hx > 0 ? 1 : -1;
    // Intersection point = x - d hx / (n.d): relative to p, times -n.d, which is linear in v.
    const Vec3d g0 = sign * (-h0 * (s.x - p) + hx * s.d0), g1 = sign * (-h1 * (s.x - p) + hx * (s.d0 + s.step));
    const auto beyond = [&](double f, double side) {
        return where_positive(side * sign * (hx + f * h0), side * sign * (hx + f * h1));
    };
    return {g0, g1 - g0, -sign * h0, sign * (h0 - h1),
        hx == 0 ? Interval{} : both(beyond(s.between.from, 1), beyond(s.between.to, -1))};
}

}  // namespace crescent::inline scene
