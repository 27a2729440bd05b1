// phong: a cosine-power lobe about R = reflect(-wo, n). Part of it may lie under the horizon of n: such samples weigh
// 0 and count; p is not renormalised.
//   p = (s+1)/(2 pi) (w.R)_+^s;  cos = u1^(1/(s+1)), phi = 2 pi u2, about R.
// On the drawn direction (w.R)^s = u1 / cos: the density costs a division, not a second power.
#pragma once

#include "arms/sampler.h"

namespace crescent {

template <class F> struct Phong {
    static constexpr std::string_view name = "phong";
    F s, inverse, scale;
    explicit Phong(const Site<F>& site)
        : s(site.s),
          inverse(number<F>(1) / (site.s + number<F>(1))),
          scale((site.s + number<F>(1)) * number<F>(0.5 / pi)) {}

    [[gnu::always_inline]] Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const Power<F> lobe = root(u.x, inverse);
        const F cos = lobe.value;
        const F sin = sqrt(lobe.one_minus * (number<F>(1) + cos));
        const SinCos<F> phi = sincos_turns(u.y);
        const Frame<F> about = frame_about(mirror(wo));
        const F along = u.x / larger(cos, number<F>(1e-30));  // (w.R)^s; u1 = 0 is 0, not 0/0
        return {about.to_world({sin * phi.cos, sin * phi.sin, cos}), {scale * along}};
    }
    [[gnu::always_inline]] PerSr<F> pdf(Vec3<F> wo, Vec3<F> wi) const {
        return {scale * cosine_power(wi, mirror(wo), s)};
    }
};

}  // namespace crescent
