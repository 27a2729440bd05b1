// half-power: a cosine power of the half vector h about n, by the factor that is exact for its normals.
//   (s+2)/(8 pi) (n.h)^s       Akenine-Moller, Haines & Hoffman 2008, "Real-Time Rendering", 3rd ed., section 7.6
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/lobes/lobe.h"

namespace crescent {

template <class F> struct HalfPowerLobe {
    static constexpr std::string_view name = "half-power";
    static constexpr bool present = true;
    static constexpr LobeDoc manual = {.label = "Half-power",
        .summary = "a cosine power of exponent s of the half vector, with the simple factor",
        .formula = R"(\frac{s+2}{8\pi}\,(n\cdot h)^s)",
        .parameter = LobeParameter::s,
        .own_arm = "blinn"};
    F s, scale;
    HalfPowerLobe(F s_, F /*alpha*/) : s(s_), scale((s_ + number<F>(2)) * number<F>(1 / (8 * pi))) {}
    F operator()(Vec3<F> wo, Vec3<F> wi) const {
        const Vec3<F> n = {number<F>(0), number<F>(0), number<F>(1)};
        return both_above(wo, wi, scale * cosine_power(normalize(wo + wi), n, s));
    }

    static double exponent(double s, double /*alpha*/) { return s; }
    static LobeWidth width(double s, double /*alpha*/) { return {2 / std::sqrt(s), std::min(pi, 18 / std::sqrt(s))}; }

    struct Normals {
        double s;
        Normals(double s_, double /*alpha*/) : s(s_) {}
        double height(double u) const { return math::pow(u, 1 / (s + 1)); }
        double below(double cos) const { return math::pow(cos, s + 1); }
        double density(double cos) const { return (s + 1) / (2 * pi) * math::pow(cos, s); }
    };
};

}  // namespace crescent
