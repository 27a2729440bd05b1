// phong: a cosine-power lobe about R = reflect(-wo, n). Part of it may lie below the horizon of n: such samples have
// weight 0 and count; p is not renormalised.
//   p = (s+1)/(2 pi) (w.R)_+^s;  cos = u1^(1/(s+1)), phi = 2 pi u2, about R.
// On the drawn direction (w.R)^s = u1 / cos: the density costs a division, not a second power.
#pragma once

#include "math/functions.h"
#include "samplers/sampler.h"

namespace crescent {

template <class F> struct Phong {
    static constexpr std::string_view name = "phong";
    static constexpr CaseSurface check_cases[] = {{.lobe = "phong", .sharpness = 8}, {.lobe = "phong", .sharpness = 32},
        {.lobe = "phong", .sharpness = 128}, {.lobe = "phong", .sharpness = 1e4}, {.lobe = "phong", .sharpness = 1e5},
        {.lobe = "phong", .sharpness = 32, .lambert = true}, {.lambert = true}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "a cosine-power lobe of exponent s about the mirror direction R",
        .formula = R"(\frac{s+1}{2\pi}\,(\omega\cdot R)_+^s)",
        .draw = R"($\cos\theta=u_1^{1/(s+1)}$)",
        .axis = "the mirror direction $R$",
        .about = PdfAxis::mirror,
        .needs_s = true,
        .check_cases = check_cases,
        .gl = {7e-6, "u^(1/(s+1)) by a plain log2 and exp2, then divided by"}};
    /// On Lambert (w.R)^s falls off faster than the integrand: Pareto weights, and beyond 90 deg from R no samples at
    /// all.
    static ExpectedBehaviour theory(const CasePoint& point) {
        if (!(point.rho_d > 0)) return {.bounded = true};
        const bool tilted = point.theta_deg > 0;
        ExpectedBehaviour t;
        t.lost = (1 - math::cos(point.theta_deg * pi / 180)) / 2;
        t.lost_of = point.rho_d;
        t.underflows = power_underflows(point, 1e-3);  // 1e-6 of Lambert's light is below
        t.tail_k = tilted ? point.s / (point.s + 1) : (point.s - 1) / (point.s + 1);
        if (tilted) t.wrong = "support";
        t.why = tilted
            ? "the lobe about R does not reach all of n's hemisphere, and Lambert does: the article's second error"
            : "p falls off as (w.R)^s while Lambert only falls off as cos: the weight is Pareto, k = (s-1)/(s+1)";
        return t;
    }
    F s, inverse, scale;
    explicit Phong(const ShadingPoint<F>& shading_point)
        : s(shading_point.s),
          inverse(number<F>(1) / (shading_point.s + number<F>(1))),
          scale((shading_point.s + number<F>(1)) * number<F>(0.5 / pi)) {}

    [[gnu::always_inline]] Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const Power<F> lobe = root(u.x, inverse);
        const F cos = lobe.value;
        const F sin = sqrt(lobe.one_minus * (number<F>(1) + cos));
        const SinCos<F> phi = sincos_turns(u.y);
        const Frame<F> lobe_frame = frame_about(mirror(wo));
        const F power = u.x / larger(cos, number<F>(1e-30));  // (w.R)^s; u1 = 0 gives 0, not 0/0
        return {lobe_frame.to_world({sin * phi.cos, sin * phi.sin, cos}), {scale * power}};
    }
    [[gnu::always_inline]] PerSr<F> pdf(Vec3<F> wo, Vec3<F> wi) const {
        return {scale * cosine_power(wi, mirror(wo), s)};
    }
};

}  // namespace crescent
