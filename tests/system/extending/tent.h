// tent: a density that is linear in the height of wi, half of it even over the hemisphere.
//   p = (1 + n.w) / (3 pi);  cos = 3 u1 / (1 + sqrt(1 + 3 u1)), phi = 2 pi u2, about n.
#pragma once

#include "samplers/sampler.h"

namespace crescent {

template <class F> struct Tent {
    static constexpr std::string_view name = "tent";
    static constexpr CaseSurface check_cases[] = {
        {.lambert = true}, {.lobe = "ggx", .sharpness = 0.5, .lambert = true}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "linear in the cosine with the normal",
        .formula = R"(\frac{1+(n\cdot\omega)}{3\pi})",
        .draw = R"($\cos\theta=\frac{3u_1}{1+\sqrt{1+3u_1}}$)",
        .axis = "the normal $n$",
        .about = PdfAxis::normal,
        .check_cases = check_cases};
    static ExpectedBehaviour theory(const CasePoint&) { return {.bounded = true}; }

    explicit Tent(const ShadingPoint<F>&) {}

    Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const F three_u = number<F>(3) * u.x;
        const F cos = three_u / (number<F>(1) + sqrt(number<F>(1) + three_u));
        const F sin = sqrt(larger((number<F>(1) - cos) * (number<F>(1) + cos), number<F>(0)));
        const SinCos<F> phi = sincos_turns(u.y);
        const Vec3<F> wi = {sin * phi.cos, sin * phi.sin, cos};
        return {wi, pdf(wo, wi)};
    }
    PerSr<F> pdf(Vec3<F>, Vec3<F> wi) const {
        const F p = (number<F>(1) + wi.z) * number<F>(1 / (3 * pi));
        return {select(wi.z > number<F>(0), p, number<F>(0))};
    }
};

}  // namespace crescent
