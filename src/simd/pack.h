// Packs of floats over Highway's static target: the only intrinsics of crescent. The file that includes this one is
// compiled with one instruction set's flags and names it in CRESCENT_ISA (sse4, avx2, avx512), which becomes the
// namespace, so that no two instruction sets share a symbol. No operation here contracts or reassociates.
#pragma once

#ifndef CRESCENT_ISA
#error "simd/pack.h wants CRESCENT_ISA: sse4, avx2 or avx512"
#endif
#define HWY_COMPILE_ONLY_STATIC
#define HWY_DISABLE_BMI2_FMA
#define HWY_DISABLE_PCLMUL_AES
#include <hwy/highway.h>

#include "simd/scalar.h"

#define CRESCENT_INLINE inline __attribute__((always_inline))

namespace crescent {
namespace CRESCENT_ISA {

namespace hn = hwy::HWY_NAMESPACE;
using FloatTag = hn::ScalableTag<float>;
using UintTag = hn::RebindToUnsigned<FloatTag>;

struct Mask {
    hn::Mask<FloatTag> m;
};
CRESCENT_INLINE Mask operator&(Mask a, Mask b) { return {hn::And(a.m, b.m)}; }
CRESCENT_INLINE Mask operator|(Mask a, Mask b) { return {hn::Or(a.m, b.m)}; }
CRESCENT_INLINE Mask operator!(Mask a) { return {hn::Not(a.m)}; }
CRESCENT_INLINE bool any(Mask a) { return !hn::AllFalse(FloatTag{}, a.m); }

/// 32-bit unsigned integers, one a lane, modulo 2^32.
struct Uint {
    hn::Vec<UintTag> v;
    Uint() = default;
    CRESCENT_INLINE Uint(hn::Vec<UintTag> x) : v(x) {}
    CRESCENT_INLINE Uint(std::uint32_t x) : v(hn::Set(UintTag{}, x)) {}
};
CRESCENT_INLINE Uint operator+(Uint a, Uint b) { return hn::Add(a.v, b.v); }
CRESCENT_INLINE Uint operator*(Uint a, Uint b) { return hn::Mul(a.v, b.v); }
CRESCENT_INLINE Uint operator^(Uint a, Uint b) { return hn::Xor(a.v, b.v); }
CRESCENT_INLINE Uint operator&(Uint a, Uint b) { return hn::And(a.v, b.v); }
CRESCENT_INLINE Uint operator|(Uint a, Uint b) { return hn::Or(a.v, b.v); }
CRESCENT_INLINE Uint operator-(Uint a, Uint b) { return hn::Sub(a.v, b.v); }
CRESCENT_INLINE Mask operator>(Uint a, Uint b) { return {hn::RebindMask(FloatTag{}, hn::Gt(a.v, b.v))}; }
CRESCENT_INLINE Mask operator==(Uint a, Uint b) { return {hn::RebindMask(FloatTag{}, hn::Eq(a.v, b.v))}; }
template <int n> CRESCENT_INLINE Uint shift_right(Uint a) { return hn::ShiftRight<n>(a.v); }
template <int n> CRESCENT_INLINE Uint shift_left(Uint a) { return hn::ShiftLeft<n>(a.v); }

/// IEEE 754 single precision, one number a lane.
struct Pack {
    hn::Vec<FloatTag> v;
    Pack() = default;
    CRESCENT_INLINE Pack(hn::Vec<FloatTag> x) : v(x) {}
    CRESCENT_INLINE Pack(float x) : v(hn::Set(FloatTag{}, x)) {}
    static constexpr std::size_t lanes = HWY_MAX_BYTES / sizeof(float);
};
CRESCENT_INLINE Pack operator+(Pack a, Pack b) { return hn::Add(a.v, b.v); }
CRESCENT_INLINE Pack operator-(Pack a, Pack b) { return hn::Sub(a.v, b.v); }
CRESCENT_INLINE Pack operator*(Pack a, Pack b) { return hn::Mul(a.v, b.v); }
CRESCENT_INLINE Pack operator/(Pack a, Pack b) { return hn::Div(a.v, b.v); }
CRESCENT_INLINE Pack operator-(Pack a) { return hn::Neg(a.v); }
CRESCENT_INLINE Mask operator<(Pack a, Pack b) { return {hn::Lt(a.v, b.v)}; }
CRESCENT_INLINE Mask operator>(Pack a, Pack b) { return {hn::Gt(a.v, b.v)}; }
CRESCENT_INLINE Mask operator<=(Pack a, Pack b) { return {hn::Le(a.v, b.v)}; }
CRESCENT_INLINE Mask operator>=(Pack a, Pack b) { return {hn::Ge(a.v, b.v)}; }
CRESCENT_INLINE Mask operator==(Pack a, Pack b) { return {hn::Eq(a.v, b.v)}; }

CRESCENT_INLINE Pack select(Mask m, Pack a, Pack b) { return hn::IfThenElse(m.m, a.v, b.v); }
CRESCENT_INLINE Uint select(Mask m, Uint a, Uint b) {
    return hn::IfThenElse(hn::RebindMask(UintTag{}, m.m), a.v, b.v);
}
CRESCENT_INLINE Pack sqrt(Pack a) { return hn::Sqrt(a.v); }
CRESCENT_INLINE Pack abs(Pack a) { return hn::Abs(a.v); }
CRESCENT_INLINE Uint bits(Pack a) { return hn::BitCast(UintTag{}, a.v); }
CRESCENT_INLINE void store(Pack a, float* p) { hn::StoreU(a.v, FloatTag{}, p); }
CRESCENT_INLINE void store(Uint a, std::uint32_t* p) { hn::StoreU(a.v, UintTag{}, p); }

}  // namespace CRESCENT_ISA

template <> struct Lanes<CRESCENT_ISA::Pack> {
    using Mask = CRESCENT_ISA::Mask;
    using Uint = CRESCENT_ISA::Uint;
    static constexpr std::size_t count = CRESCENT_ISA::Pack::lanes;
};
template <> CRESCENT_INLINE CRESCENT_ISA::Pack from_bits<CRESCENT_ISA::Pack>(CRESCENT_ISA::Uint u) {
    return CRESCENT_ISA::hn::BitCast(CRESCENT_ISA::FloatTag{}, u.v);
}
template <> CRESCENT_INLINE CRESCENT_ISA::Pack to_float<CRESCENT_ISA::Pack>(CRESCENT_ISA::Uint u) {
    namespace hn = CRESCENT_ISA::hn;
    const hn::RebindToSigned<CRESCENT_ISA::FloatTag> signed_tag;
    return hn::ConvertTo(CRESCENT_ISA::FloatTag{}, hn::BitCast(signed_tag, u.v));
}

template <> CRESCENT_INLINE CRESCENT_ISA::Pack load_as<CRESCENT_ISA::Pack>(const float* p) {
    return CRESCENT_ISA::hn::LoadU(CRESCENT_ISA::FloatTag{}, p);
}
template <> CRESCENT_INLINE CRESCENT_ISA::Uint load_as<CRESCENT_ISA::Uint>(const std::uint32_t* p) {
    return CRESCENT_ISA::hn::LoadU(CRESCENT_ISA::UintTag{}, p);
}

}  // namespace crescent
