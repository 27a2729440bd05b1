// uniform: the hemisphere of n, every solid angle alike.
//   p = 1/(2 pi);  cos = u1, phi = 2 pi u2, about n.
#pragma once

#include "arms/sampler.h"

namespace crescent {

template <class F> struct Uniform {
    static constexpr std::string_view name = "uniform";
    explicit Uniform(const Site<F>&) {}

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
