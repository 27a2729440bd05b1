// rectangle: a rectangle that emits along edge_u x edge_v, or from both sides.
//   By solid angle: Urena, Fajardo & King 2013, "An Area-Preserving Parametrization for Spherical Rectangles", CGF
//   32(4). With the point at the origin, the rectangle [x0, x1] x [y0, y1] at height z0 and
//     b0 = -y0 / sqrt(z0^2 + y0^2),  b1 = y1 / sqrt(z0^2 + y1^2),  D(x) = asin(b0 h) + asin(b1 h),
//     h = x / sqrt(z0^2 + x^2),
//   D(x) - D(x0) is the solid angle of the part before x (their eq. (3), its angles as differences to pi/2, which do
//   not cancel): u1 gives D and so x, u2 gives y; p = 1 / (D(x1) - D(x0)). Below 1e-4 sr floats are too coarse for
//   that, and points are uniform on the rectangle, as they are by area: p = |y|^3 / (area |z0|).
#pragma once

#include <algorithm>
#include <optional>

#include "math/functions.h"
#include "scene/lights/light_kind.h"

namespace crescent::lights {

struct Rectangle {
    static constexpr std::string_view name = "rectangle";
    static constexpr std::string_view summary = "a rectangle that shines along edge_u x edge_v, or from both sides";
    Vec3d corner{}, edge_u{}, edge_v{};
    bool two_sided = false;

    static constexpr auto parameters() {
        return std::array{parameter::place("corner", &Rectangle::corner, "A corner."),
            parameter::place("edge_u", &Rectangle::edge_u, "First edge from the corner."),
            parameter::place("edge_v", &Rectangle::edge_v, "Second edge; edge_u x edge_v is the side that shines."),
            parameter::flag("two_sided", &Rectangle::two_sided, "Emits from both sides.")};
    }
    std::optional<Mistake> mistake() const {
        if (const auto mistake = shapes::mistake_of_edges(edge_u, edge_v)) return mistake;
        if (std::fabs(dot(edge_u, edge_v)) > 1e-6 * std::sqrt(dot(edge_u, edge_u) * dot(edge_v, edge_v)))
            return Mistake{"edge_v", "expected an edge at a right angle to edge_u"};
        return {};
    }

    static constexpr Rectangle example() { return {{-0.45, 1.04, 2.35}, {-0.7, -0.6, 0}, {-0.48, 0.56, -0.92}}; }

    shapes::Quad body() const { return {corner, edge_u, edge_v}; }
    Vec3d normal() const { return normalize(cross(edge_u, edge_v)); }
    bool shines_on(Vec3d x) const {
        const double radius = 0.5 * std::sqrt(dot(edge_u, edge_u) + dot(edge_v, edge_v));
        return shines_flat(body().middle() - x, normal(), radius, two_sided);
    }
    Figure seen_from(Vec3d) const { return body(); }
    double disk_area() const { return std::sqrt(dot(edge_u, edge_u) * dot(edge_v, edge_v)) / pi; }

    /// a: to the centre, m; b, c: the edges, unit. The numbers: half the edges' lengths; the solid angle, 0 if below
    /// 1e-4 sr; D(x0); b0; b0 + b1; 1 if it shines on x.
    LightNumbers numbers(Vec3d x, const Frame<double>& frame) const {
        const double u = std::sqrt(dot(edge_u, edge_u)), v = std::sqrt(dot(edge_v, edge_v));
        const Vec3d d = body().middle() - x, b = edge_u * (1 / u), c = edge_v * (1 / v);
        const double z2 = sqr(dot(d, cross(b, c))), centre_x = dot(d, b), centre_y = dot(d, c);
        const auto slope = [&](double from) { return from / std::sqrt(z2 + from * from); };
        const double b0 = -slope(centre_y - v / 2), b1 = slope(centre_y + v / 2);
        const auto angle_to = [&](double height) {
            return math::asin(b0 * slope(height)) + math::asin(b1 * slope(height));
        };
        const bool shines = shines_on(x);
        const double from = shines ? angle_to(centre_x - u / 2) : 0,
                     solid_angle = shines ? angle_to(centre_x + u / 2) - from : 0;
        return {.a = frame.to_local(d),
            .b = frame.to_local(b),
            .c = frame.to_local(c),
            .number = {u / 2, v / 2, solid_angle > 1e-4 ? solid_angle : 0, from, b0, b0 + b1, shines ? 1.0 : 0.0}};
    }
    template <class F> static MaskOf<F> shines(const LocalLight<F>& l) { return l.number[6] > number<F>(0); }
    /// From the centre to the middle of an edge, along edge_u and edge_v.
    template <class F> static std::array<Vec3<F>, 2> half_edges(const LocalLight<F>& l) {
        return {l.b * l.number[0], l.c * l.number[1]};
    }

    /// w meets its plane at (height / v) w; testing whether that point is inside needs no division.
    template <class F> static MaskOf<F> meets(const LocalLight<F>& l, Vec3<F> w, F& t) {
        const Vec3<F> n = cross(l.b, l.c);
        const F height = dot(l.a, n), v = dot(w, n);
        const auto is_ahead = height * v > number<F>(0);
        t = height / select(is_ahead, v, number<F>(1));
        const Vec3<F> offset = w * height - l.a * v;
        return (abs(dot(offset, l.b)) <= l.number[0] * abs(v)) & (abs(dot(offset, l.c)) <= l.number[1] * abs(v)) &
            is_ahead & shines(l);
    }
    template <class F> static F radius2(const LocalLight<F>& l) { return sqr(l.number[0]) + sqr(l.number[1]); }

    template <class F> static Aimed<F> by_area(const LocalLight<F>& l, Vec2<F> u) {
        const F one = number<F>(1), two = number<F>(2);
        const Vec3<F> y = l.a + l.b * (l.number[0] * (two * u.x - one)) + l.c * (l.number[1] * (two * u.y - one));
        const F t2 = dot(y, y), t = sqrt(t2), height = abs(dot(l.a, cross(l.b, l.c)));
        return {y * (one / t),
            select(shines(l), area_density(l) * t2 * t / larger(height, number<F>(1e-30)), number<F>(0))};
    }
    template <class F> static F area_pdf(const LocalLight<F>& l, Vec3<F> w) {
        F t;
        const auto is_hit = meets(l, w, t);
        const F cos = abs(dot(w, cross(l.b, l.c)));
        return select(is_hit, area_density(l) * sqr(t) / larger(cos, number<F>(1e-30)), number<F>(0));
    }

    template <class F> static Aimed<F> by_angle(const LocalLight<F>& l, Vec2<F> u) {
        const F zero = number<F>(0), one = number<F>(1), tiny = number<F>(1e-30);
        const Vec3<F> n = cross(l.b, l.c);
        const F z = dot(l.a, n), z2 = sqr(z), centre_x = dot(l.a, l.b), centre_y = dot(l.a, l.c);
        const SinCos<F> d = sincos_turns((l.number[3] + u.x * l.number[2]) * number<F>(0.5 / pi));
        const F sin2 = sqr(d.sin), b0 = l.number[4];
        const F sum = l.number[5] - sin2 / (one + larger(d.cos, number<F>(-0.9999))) * b0;  // b0 cos D + b1
        const F x_there = abs(z) * d.sin / sqrt(larger(sqr(sum) - (one - sqr(b0)) * sin2, tiny));
        const F x = smaller(larger(x_there, centre_x - l.number[0]), centre_x + l.number[0]);
        const F far2 = sqr(x) + z2, low = centre_y - l.number[1], high = centre_y + l.number[1];
        const F h0 = low / sqrt(far2 + sqr(low)), h1 = high / sqrt(far2 + sqr(high)), h = h0 + u.y * (h1 - h0);
        const F y_there = h * sqrt(far2 / larger((one - h) * (one + h), tiny));
        const F y = smaller(larger(y_there, low), high);
        const Vec3<F> to = l.b * x + l.c * y + n * z;
        const Aimed<F> area_draw = by_area(l, u);
        const auto is_large = l.number[2] > zero;
        const Vec3<F> wi = to * (one / sqrt(larger(dot(to, to), tiny)));
        return {{select(is_large, wi.x, area_draw.wi.x), select(is_large, wi.y, area_draw.wi.y),
                    select(is_large, wi.z, area_draw.wi.z)},
            select(is_large, one / larger(l.number[2], tiny), area_draw.pdf)};
    }
    template <class F> static F angle_pdf(const LocalLight<F>& l, Vec3<F> w) {
        F t;
        const F zero = number<F>(0);
        const auto is_large = l.number[2] > zero;
        const F uniform_pdf = select(meets(l, w, t), number<F>(1) / larger(l.number[2], number<F>(1e-30)), zero);
        return select(is_large, uniform_pdf, area_pdf(l, w));
    }

private:
    template <class F> static F area_density(const LocalLight<F>& l) {  // 1/m^2
        return number<F>(0.25) / (l.number[0] * l.number[1]);
    }
};

}  // namespace crescent::lights
