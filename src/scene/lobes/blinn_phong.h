// blinn-phong: a cosine power of the half vector h about n.
//   (s+2)(s+4)/(8 pi (2^(-s/2) + s)) (n.h)^s    Giesen 2009, "Phong and Blinn-Phong normalization factors"
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/lobes/lobe.h"

namespace crescent {

template <class F> struct BlinnPhongLobe {
    static constexpr std::string_view name = "blinn-phong";
    static constexpr bool present = true;
    static constexpr LobeDoc manual = {.label = "Blinn-Phong",
        .summary = "a cosine power of exponent s of the half vector about the normal",
        .formula = R"(\frac{(s+2)(s+4)}{8\pi(2^{-s/2}+s)}\,(n\cdot h)^s)",
        .parameter = LobeParameter::s,
        .own_arm = "blinn"};
    F s, scale;
    BlinnPhongLobe(F s_, F)
        : s(s_),
          scale((s_ + number<F>(2)) * (s_ + number<F>(4)) / (number<F>(8 * pi) * (exp2(number<F>(-0.5) * s_) + s_))) {}
    [[gnu::always_inline]] F operator()(Vec3<F> wo, Vec3<F> wi) const {
        const F f = scale * cosine_power(normalize(wo + wi), Vec3<F>{number<F>(0), number<F>(0), number<F>(1)}, s);
        return both_above(wo, wi, f);
    }

    static double exponent(double s, double) { return s; }
    /// The half vector turns by at least half the angle of wi.
    static LobeWidth width(double s, double) {
        const double width = 2 / std::sqrt(s);
        return {width, std::min(pi, 9 * width)};
    }

    struct Normals {
        double s;
        Normals(double s_, double) : s(s_) {}
        double height(double u) const { return math::pow(u, 1 / (s + 1)); }
        double below(double c) const { return math::pow(c, s + 1); }
        double density(double c) const { return (s + 1) / (2 * pi) * math::pow(c, s); }
    };
};

}  // namespace crescent
