// square: a horizontal square that shines downwards; a rectangle in all that it does.
#pragma once

#include "scene/lights/rectangle.h"

namespace crescent::lights {

struct Square {
    static constexpr std::string_view name = "square";
    static constexpr std::string_view summary = "a horizontal square that shines downwards";
    Vec3d center{};
    double side = 0;

    static constexpr auto parameters() {
        return std::array{parameter::place("center", &Square::center, "Centre."),
            parameter::length("side", &Square::side, "Length of a side.")};
    }

    Rectangle as_rectangle() const {
        return {center - Vec3d{side / 2, 0, side / 2}, {side, 0, 0}, {0, 0, side}, false};
    }
    static constexpr Square example() { return {{0.4, 0.9, 1.1}, 0.8}; }
    shapes::Quad body() const { return as_rectangle().body(); }
    bool shines_on(Vec3d x) const { return as_rectangle().shines_on(x); }
    Figure seen_from(Vec3d x) const { return as_rectangle().seen_from(x); }
    double disk_area() const { return as_rectangle().disk_area(); }
    LightNumbers numbers(Vec3d x, const Frame<double>& frame) const { return as_rectangle().numbers(x, frame); }

    template <class F> static MaskOf<F> shines(const LocalLight<F>& l) { return Rectangle::shines(l); }
    template <class F> static MaskOf<F> meets(const LocalLight<F>& l, Vec3<F> w, F& t) {
        return Rectangle::meets(l, w, t);
    }
    template <class F> static F radius2(const LocalLight<F>& l) { return Rectangle::radius2(l); }
    template <class F> static Aimed<F> by_area(const LocalLight<F>& l, Vec2<F> u) { return Rectangle::by_area(l, u); }
    template <class F> static F area_pdf(const LocalLight<F>& l, Vec3<F> w) { return Rectangle::area_pdf(l, w); }
    template <class F> static Aimed<F> by_angle(const LocalLight<F>& l, Vec2<F> u) { return Rectangle::by_angle(l, u); }
    template <class F> static F angle_pdf(const LocalLight<F>& l, Vec3<F> w) { return Rectangle::angle_pdf(l, w); }
};

}  // namespace crescent::lights
