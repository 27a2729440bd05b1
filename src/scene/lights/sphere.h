// sphere: a ball that emits outwards, uniformly over its surface. A point inside it receives nothing from it.
//   Seen from x it fills the cone about c with sin = R / |c|: by solid angle, directions are uniform in that cone,
//     p = 1 / (2 pi (1 - cos)), 1 - cos = sin^2 / (1 + cos)       Shirley, Wang & Zimmerman 1996, "Monte Carlo
//     Techniques for Direct Lighting Calculations", section 3.2;
//   by area, points are uniform on the cap that x sees, of area 2 pi R^2 (1 - sin).
#pragma once

#include "scene/lights/light_kind.h"

namespace crescent::lights {

struct Sphere {
    static constexpr std::string_view name = "sphere";
    static constexpr std::string_view summary = "a ball that shines outwards";
    Vec3d center{};
    double radius = 0;

    static constexpr auto parameters() {
        return std::array{parameter::place("center", &Sphere::center, "Centre."),
            parameter::length("radius", &Sphere::radius, "Radius.")};
    }

    /// An example for testing samplers, which every kind has: the surface at 0, n = +z, m.
    static constexpr Sphere example() { return {{-0.61, 0.51, 1.39}, 0.45}; }

    shapes::Sphere body() const { return {center, radius}; }
    bool shines_on(Vec3d x) const { return dot(center - x, center - x) > sqr(radius * (1 + 1e-6)); }
    /// Returns the disk bounded by the tangents from x.
    Figure seen_from(Vec3d x) const {
        const Vec3d d = center - x;
        const double d2 = dot(d, d), cos2 = 1 - sqr(radius) / d2;  // cos^2 of the cone
        return shapes::Disk{x + cos2 * d, (-1 / std::sqrt(d2)) * d, radius * std::sqrt(cos2)};
    }
    double disk_area() const { return sqr(radius); }

    /// a: to the centre, m. The numbers: the radius; 1 - sin and 1 - cos of the cone; 1 if it shines on x; the
    /// distances to the centre and to the nearest point (for a large ball their difference is inexact in single
    /// precision).
    LightNumbers numbers(Vec3d x, const Frame<double>& frame) const {
        const Vec3d d = center - x;
        const double distance = std::sqrt(dot(d, d)), gap = std::max(distance - radius, 0.0);
        const double sin2 = std::min(1.0, sqr(radius) / dot(d, d)),
                     cos = std::sqrt(gap * (distance + radius)) / distance;
        return {.a = frame.to_local(d),
            .b = {},
            .c = {},
            .number = {radius, gap / distance, sin2 / (1 + cos), shines_on(x) ? 1.0 : 0.0, distance, gap}};
    }
    template <class F> static MaskOf<F> shines(const LocalLight<F>& l) { return l.number[3] > number<F>(0); }

    /// Where w meets it: a distance; that of the nearest point if w misses.
    template <class F> static MaskOf<F> meets(const LocalLight<F>& l, Vec3<F> w, F& t) {
        const F projection = dot(l.a, w);
        const Vec3<F> offset = l.a - w * projection;
        const F half2 = sqr(l.number[0]) - dot(offset, offset);
        t = l.number[5] * (l.number[4] + l.number[0]) / (projection + sqrt(larger(half2, number<F>(0))));
        return (half2 >= number<F>(0)) & (projection > number<F>(0)) & shines(l);
    }
    /// Returns the squared radius of a ball around a that contains it.
    template <class F> static F radius2(const LocalLight<F>& l) { return sqr(l.number[0]); }

    template <class F> static Aimed<F> by_angle(const LocalLight<F>& l, Vec2<F> u) {
        const F drop = u.x * l.number[2];  // 1 - cos
        const F sin = sqrt(drop * (number<F>(2) - drop));
        const SinCos<F> phi = sincos_turns(u.y);
        const Vec3<F> axis = l.a * (number<F>(1) / l.number[4]);
        const Vec3<F> e = frame_about(axis).to_world({sin * phi.cos, sin * phi.sin, -drop});
        return {axis + e, angle_density(l)};
    }
    template <class F> static F angle_pdf(const LocalLight<F>& l, Vec3<F> w) {
        F t;
        return select(meets(l, w, t), angle_density(l), number<F>(0));
    }

    /// Height z = 1 - u (1 - sin) on the sphere above its centre, towards x.
    template <class F> static Aimed<F> by_area(const LocalLight<F>& l, Vec2<F> u) {
        const F one = number<F>(1), drop = u.x * l.number[1], z = one - drop;
        const F r = sqrt(drop * (number<F>(2) - drop));
        const SinCos<F> phi = sincos_turns(u.y);
        const Vec3<F> axis = l.a * (one / l.number[4]);  // the point lies r drop behind the nearest point
        const Vec3<F> y = frame_about(axis).to_world(
            {l.number[0] * r * phi.cos, l.number[0] * r * phi.sin, l.number[5] + l.number[0] * drop});
        const F t2 = dot(y, y), t = sqrt(t2);
        const F cos = larger((z * l.number[5] - l.number[0] * drop) / t, number<F>(1e-7));  // -n.y / t
        return {y * (one / t), select(shines(l), area_density(l) * t2 / cos, number<F>(0))};
    }
    template <class F> static F area_pdf(const LocalLight<F>& l, Vec3<F> w) {
        F t;
        const auto is_hit = meets(l, w, t);
        const F projection = dot(l.a, w), cos = larger((projection - t) / l.number[0], number<F>(1e-7));
        return select(is_hit, area_density(l) * sqr(t) / cos, number<F>(0));
    }

private:
    template <class F> static F angle_density(const LocalLight<F>& l) {
        return select(shines(l), number<F>(0.5 / pi) / larger(l.number[2], number<F>(1e-30)), number<F>(0));
    }
    template <class F> static F area_density(const LocalLight<F>& l) {  // 1/m^2
        return number<F>(0.5 / pi) / (sqr(l.number[0]) * larger(l.number[1], number<F>(1e-12)));
    }
};

}  // namespace crescent::lights
