// uniform: the hemisphere of n, uniform in solid angle.
//   p = 1/(2 pi);  cos = u1, phi = 2 pi u2, about n.
#pragma once

#include "samplers/sampler.h"

namespace crescent {

template <class F> struct Uniform {
    static constexpr std::string_view name = "uniform";
    static constexpr CaseSurface check_cases[] = {{.lambert = true},
        {.lobe = "phong", .sharpness = 32, .lambert = true}, {.lobe = "ggx", .sharpness = 0.5, .lambert = true},
        {.lambert = true, .light = "fill + disk"}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "every direction above the surface alike",
        .formula = R"(\frac{1}{2\pi})",
        .draw = R"($\cos\theta=u_1$)",
        .axis = "the normal $n$",
        .about = PdfAxis::normal,
        .check_cases = check_cases,
        .gl = {2.5e-6, "cos times the lobe: (w.R)^s turns 1e-7 of w.R into s 1e-7 of the lobe"}};
    static ExpectedBehaviour theory(const CasePoint&) { return {.bounded = true}; }
    explicit Uniform(const ShadingPoint<F>&) {}

    [[gnu::always_inline]] Drawn<F> sample(Vec3<F> /*wo*/, Vec2<F> u) const {
        const F sin = sqrt(number<F>(1) - u.x * u.x);
        const SinCos<F> phi = sincos_turns(u.y);
        return {{sin * phi.cos, sin * phi.sin, u.x}, {number<F>(0.5 / pi)}};
    }
    [[gnu::always_inline]] PerSr<F> pdf(Vec3<F> /*wo*/, Vec3<F> wi) const {
        return {select(wi.z > number<F>(0), number<F>(0.5 / pi), number<F>(0))};
    }
};

}  // namespace crescent
