// A float that counts its operations, in the vocabulary of simd/scalar.h: the arithmetic of one sample. The operations
// of a sampler and a lobe are counted in their own source; those of the kernels are repeated in accumulate(). + - * /
// and sqrt count one each; comparisons, selections and integers none.
#pragma once

#include "crescent/crescent.h"

namespace crescent {

struct Counted {
    float v = 0;
    static inline std::uint64_t operations = 0;

    Counted() = default;
    explicit constexpr Counted(float x) : v(x) {}
    static Counted did(float x) {
        ++operations;
        return Counted(x);
    }
};

template <> struct Lanes<Counted> {
    using Mask = bool;
    using Uint = std::uint32_t;
    static constexpr std::size_t count = 1;
};

inline Counted operator+(Counted a, Counted b) { return Counted::did(a.v + b.v); }
inline Counted operator-(Counted a, Counted b) { return Counted::did(a.v - b.v); }
inline Counted operator*(Counted a, Counted b) { return Counted::did(a.v * b.v); }
inline Counted operator/(Counted a, Counted b) { return Counted::did(a.v / b.v); }
inline Counted operator-(Counted a) { return Counted(-a.v); }
inline bool operator<(Counted a, Counted b) { return a.v < b.v; }
inline bool operator<=(Counted a, Counted b) { return a.v <= b.v; }
inline bool operator>(Counted a, Counted b) { return a.v > b.v; }
inline bool operator>=(Counted a, Counted b) { return a.v >= b.v; }
inline bool operator==(Counted a, Counted b) { return a.v == b.v; }
inline Counted select(bool m, Counted a, Counted b) { return m ? a : b; }
inline Counted sqrt(Counted a) { return Counted::did(std::sqrt(a.v)); }
inline Counted abs(Counted a) { return Counted(std::fabs(a.v)); }
inline std::uint32_t bits(Counted a) { return bits(a.v); }
template <> inline Counted from_bits<Counted>(std::uint32_t u) { return Counted(from_bits<float>(u)); }
template <> inline Counted to_float<Counted>(std::uint32_t u) { return Counted(to_float<float>(u)); }

namespace bench {

/// The estimator's operations for a direction: g = cos/p, X, its square, the test against one disk; the lobe if there
/// is one.
template <class L>
Counted accumulate(const ShadingPoint<Counted>& shading_point, const Drawn<Counted>& drawn, Counted weight) {
    const LocalDisk<Counted>& disk = shading_point.disks[0];
    const L lobe(shading_point.s, shading_point.alpha);
    const Counted g = weight * (drawn.wi.z / drawn.pdf.v), f = lobe(shading_point.wo, drawn.wi);
    const Counted x = g * (shading_point.diffuse + f * shading_point.lobe), off = x - shading_point.diffuse;
    const Counted along = dot(drawn.wi, disk.normal);
    const Vec3<Counted> miss = drawn.wi * disk.radius - disk.to_center * along;
    return dot(miss, miss) * (along * along) + (off * off + g) + g * f;
}

/// Returns the operations of one sample of a sampler on a surface with lobe L under one disk, without shadows and
/// random integers.
template <template <class> class A, class L> std::uint64_t operations_per_sample() {
    const auto c = [](double x) { return Counted(static_cast<float>(x)); };
    const LocalDisk<Counted> disk{{c(1), c(0.5), c(2)}, {c(0), c(0), c(-1)}, c(0.1), c(0), c(1)};
    const ShadingPoint<Counted> shading_point{{c(0.6), c(0), c(0.8)}, c(32), c(0.2), c(0.17), c(0.12), &disk, 1};
    const A<Counted> arm(shading_point);
    Counted::operations = 0;
    const Vec2<Counted> u{unit_float<Counted>(0x51234567u), unit_float<Counted>(0x9abcdef0u)};
    if constexpr (requires { A<Counted>::techniques; }) {
        const Drawn<Counted> a = arm.template sample_technique<0>(shading_point.wo, u),
                             b = arm.template sample_technique<1>(shading_point.wo, u);
        accumulate<L>(shading_point, a, arm.template weight<0>(shading_point.wo, a)),
            accumulate<L>(shading_point, b, arm.template weight<1>(shading_point.wo, b));
    } else {
        accumulate<L>(shading_point, arm.sample(shading_point.wo, u), c(1));
    }
    return Counted::operations;
}

}  // namespace bench
}  // namespace crescent
