// cosine: the hemisphere of n by projected solid angle, exact for Lambert under constant light.
//   p = (n.w)/pi;  cos = sqrt(u1), phi = 2 pi u2, about n.
#pragma once

#include "samplers/sampler.h"

namespace crescent {

template <class F> struct Cosine {
    static constexpr std::string_view name = "cosine";
    static constexpr CaseSurface check_cases[] = {{.lambert = true},
        {.lobe = "phong", .sharpness = 32, .lambert = true}, {.lobe = "ggx", .sharpness = 0.5, .lambert = true},
        {.lambert = true, .light = "fill + disk"}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "by the cosine with the normal: exact for Lambert under constant light",
        .formula = R"(\frac{(n\cdot\omega)}{\pi})",
        .draw = R"($\cos\theta=\sqrt{u_1}$)",
        .axis = "the normal $n$",
        .about = PdfAxis::normal,
        .check_cases = check_cases,
        .gl = {2.5e-6, "as uniform; cos/p is a constant"}};
    static ExpectedBehaviour theory(const CasePoint&) { return {.bounded = true}; }
    explicit Cosine(const ShadingPoint<F>&) {}

    [[gnu::always_inline]] Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const F sin = sqrt(number<F>(1) - u.x);
        const SinCos<F> phi = sincos_turns(u.y);
        const Vec3<F> wi = {sin * phi.cos, sin * phi.sin, sqrt(u.x)};
        return {wi, pdf(wo, wi)};
    }
    [[gnu::always_inline]] PerSr<F> pdf(Vec3<F> /*wo*/, Vec3<F> wi) const {
        return {select(wi.z > number<F>(0), wi.z * number<F>(1 / pi), number<F>(0))};
    }
};

}  // namespace crescent
