// phong: a cosine power about the mirror direction R, normalised for the case that all of it is above the horizon.
//   (s+2)/(2 pi) (wi.R)_+^s          Lafortune & Willems 1994, "Using the modified Phong BRDF"
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/lobes/lobe.h"

namespace crescent {

template <class F> struct PhongLobe {
    static constexpr std::string_view name = "phong";
    static constexpr bool present = true;
    static constexpr LobeDoc manual = {.label = "Phong",
        .summary = "a cosine power of exponent s about the mirror direction",
        .formula = R"(\frac{s+2}{2\pi}\,(\omega_i\cdot R)_+^s)",
        .parameter = LobeParameter::s,
        .about_mirror = true,
        .own_arm = "phong"};
    F s, scale;
    PhongLobe(F s_, F) : s(s_), scale((s_ + number<F>(2)) * number<F>(0.5 / pi)) {}
    [[gnu::always_inline]] F operator()(Vec3<F> wo, Vec3<F> wi) const {
        return scale * cosine_power(wi, mirror(wo), s);
    }

    static double exponent(double s, double) { return s; }
    /// cos^s(al) <= exp(-s al^2 / 2), 0 from pi/2 on.
    static LobeWidth width(double s, double) {
        const double width = 1 / std::sqrt(s);
        return {width, std::min(pi / 2, 9 * width)};
    }

    /// Polar about R at tilt theta. The cosine n.w = a + b cos(phi), a = cos(al) cos(theta), b = sin(al) sin(theta),
    /// integrates over phi in closed form, cut where it turns negative; one integral over al remains.
    template <class Integrate> static double albedo(double s, double, double cos_o, Integrate&& integrate) {
        const double sin_o = std::sqrt(1 - cos_o * cos_o);
        const auto ring = [&](double al) {
            const auto [sin, cos] = math::sincos(al);
            const double a = cos * cos_o, b = sin * sin_o;
            double band = 2 * pi * a;
            if (b > a) {
                const double phi = math::acos(-a / b);
                band = 2 * (a * phi + b * math::sin(phi));
            }
            return math::pow(cos, s) * sin * band;
        };
        const double horizon = math::asin(cos_o);                      // al where the lobe first crosses the horizon
        const double reach = std::min(pi / 2, 12 / std::sqrt(s + 1));  // beyond, cos^s < exp(-70)
        const double cut = std::min(horizon, reach);
        return (s + 2) / (2 * pi) * (integrate(ring, 0.0, cut) + integrate(ring, cut, reach));
    }
};

}  // namespace crescent
