// Packs of floats over Highway's static target: the only intrinsics of crescent. The file that includes this one is
// compiled with one instruction set's flags and names it in CRESCENT_ISA (a name of the list in render/kernel.cpp),
// which becomes the namespace, so that no two instruction sets share a symbol. No operation here contracts or
// reassociates.
//
// A pack is two vectors: a sample is one long chain of dependent operations, and a second, independent chain fills the
// latency of each step of the first.
#pragma once

#ifndef CRESCENT_ISA
#error "simd/pack.h needs CRESCENT_ISA: a name of the list in render/kernel.cpp"
#endif
#define HWY_COMPILE_ONLY_STATIC
#define HWY_DISABLE_BMI2_FMA
#define HWY_DISABLE_PCLMUL_AES
#include <hwy/highway.h>

#include "math/simd/scalar.h"

namespace crescent {
namespace CRESCENT_ISA {

namespace hn = hwy::HWY_NAMESPACE;
using FloatTag = hn::ScalableTag<float>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using FloatVec = hn::Vec<FloatTag>;
using UintVec = hn::Vec<UintTag>;
inline constexpr std::size_t half_lanes = HWY_MAX_BYTES / sizeof(float);

/// One boolean per lane.
struct Mask {
    hn::Mask<FloatTag> a, b;
};
CRESCENT_ALWAYS_INLINE Mask operator&(Mask x, Mask y) { return {hn::And(x.a, y.a), hn::And(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Mask operator|(Mask x, Mask y) { return {hn::Or(x.a, y.a), hn::Or(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Mask operator!(Mask x) { return {hn::Not(x.a), hn::Not(x.b)}; }
CRESCENT_ALWAYS_INLINE bool any(Mask x) { return !hn::AllFalse(FloatTag{}, hn::Or(x.a, x.b)); }

/// 32-bit unsigned integers, one per lane, modulo 2^32.
struct Uint {
    UintVec a, b;
    Uint() = default;
    CRESCENT_ALWAYS_INLINE Uint(UintVec x, UintVec y) : a(x), b(y) {}
    CRESCENT_ALWAYS_INLINE Uint(std::uint32_t x) : a(hn::Set(UintTag{}, x)), b(a) {}
};
CRESCENT_ALWAYS_INLINE Mask mask_of(hn::Mask<UintTag> a, hn::Mask<UintTag> b) {
    return {hn::RebindMask(FloatTag{}, a), hn::RebindMask(FloatTag{}, b)};
}
CRESCENT_ALWAYS_INLINE Uint operator+(Uint x, Uint y) { return {hn::Add(x.a, y.a), hn::Add(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Uint operator-(Uint x, Uint y) { return {hn::Sub(x.a, y.a), hn::Sub(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Uint operator*(Uint x, Uint y) { return {hn::Mul(x.a, y.a), hn::Mul(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Uint operator^(Uint x, Uint y) { return {hn::Xor(x.a, y.a), hn::Xor(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Uint operator&(Uint x, Uint y) { return {hn::And(x.a, y.a), hn::And(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Uint operator|(Uint x, Uint y) { return {hn::Or(x.a, y.a), hn::Or(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Mask operator>(Uint x, Uint y) { return mask_of(hn::Gt(x.a, y.a), hn::Gt(x.b, y.b)); }
CRESCENT_ALWAYS_INLINE Mask operator==(Uint x, Uint y) { return mask_of(hn::Eq(x.a, y.a), hn::Eq(x.b, y.b)); }
template <int n> CRESCENT_ALWAYS_INLINE Uint shift_right(Uint x) {
    return {hn::ShiftRight<n>(x.a), hn::ShiftRight<n>(x.b)};
}
template <int n> CRESCENT_ALWAYS_INLINE Uint shift_left(Uint x) {
    return {hn::ShiftLeft<n>(x.a), hn::ShiftLeft<n>(x.b)};
}

/// IEEE 754 single precision, one number per lane.
struct Pack {
    FloatVec a, b;
    Pack() = default;
    CRESCENT_ALWAYS_INLINE Pack(FloatVec x, FloatVec y) : a(x), b(y) {}
    CRESCENT_ALWAYS_INLINE Pack(float x) : a(hn::Set(FloatTag{}, x)), b(a) {}
    static constexpr std::size_t lanes = 2 * half_lanes;
};
CRESCENT_ALWAYS_INLINE Pack operator+(Pack x, Pack y) { return {hn::Add(x.a, y.a), hn::Add(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Pack operator-(Pack x, Pack y) { return {hn::Sub(x.a, y.a), hn::Sub(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Pack operator*(Pack x, Pack y) { return {hn::Mul(x.a, y.a), hn::Mul(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Pack operator/(Pack x, Pack y) { return {hn::Div(x.a, y.a), hn::Div(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Pack operator-(Pack x) { return {hn::Neg(x.a), hn::Neg(x.b)}; }
CRESCENT_ALWAYS_INLINE Mask operator<(Pack x, Pack y) { return {hn::Lt(x.a, y.a), hn::Lt(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Mask operator>(Pack x, Pack y) { return {hn::Gt(x.a, y.a), hn::Gt(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Mask operator<=(Pack x, Pack y) { return {hn::Le(x.a, y.a), hn::Le(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Mask operator>=(Pack x, Pack y) { return {hn::Ge(x.a, y.a), hn::Ge(x.b, y.b)}; }
CRESCENT_ALWAYS_INLINE Mask operator==(Pack x, Pack y) { return {hn::Eq(x.a, y.a), hn::Eq(x.b, y.b)}; }

CRESCENT_ALWAYS_INLINE Pack select(Mask m, Pack x, Pack y) {
    return {hn::IfThenElse(m.a, x.a, y.a), hn::IfThenElse(m.b, x.b, y.b)};
}
CRESCENT_ALWAYS_INLINE Uint select(Mask m, Uint x, Uint y) {
    return {hn::IfThenElse(hn::RebindMask(UintTag{}, m.a), x.a, y.a),
        hn::IfThenElse(hn::RebindMask(UintTag{}, m.b), x.b, y.b)};
}
/// A true lane's mask is -1.
CRESCENT_ALWAYS_INLINE Uint plus_one_where(Mask m, Uint u) {
    return {hn::Sub(u.a, hn::VecFromMask(UintTag{}, hn::RebindMask(UintTag{}, m.a))),
        hn::Sub(u.b, hn::VecFromMask(UintTag{}, hn::RebindMask(UintTag{}, m.b)))};
}
CRESCENT_ALWAYS_INLINE Pack sqrt(Pack x) { return {hn::Sqrt(x.a), hn::Sqrt(x.b)}; }
CRESCENT_ALWAYS_INLINE Pack abs(Pack x) { return {hn::Abs(x.a), hn::Abs(x.b)}; }
CRESCENT_ALWAYS_INLINE Uint bits(Pack x) { return {hn::BitCast(UintTag{}, x.a), hn::BitCast(UintTag{}, x.b)}; }
CRESCENT_ALWAYS_INLINE void store(Pack x, float* p) {
    hn::StoreU(x.a, FloatTag{}, p);
    hn::StoreU(x.b, FloatTag{}, p + half_lanes);
}
CRESCENT_ALWAYS_INLINE void store(Uint x, std::uint32_t* p) {
    hn::StoreU(x.a, UintTag{}, p);
    hn::StoreU(x.b, UintTag{}, p + half_lanes);
}

}  // namespace CRESCENT_ISA

template <> struct Lanes<CRESCENT_ISA::Pack> {
    using Mask = CRESCENT_ISA::Mask;
    using Uint = CRESCENT_ISA::Uint;
    static constexpr std::size_t count = CRESCENT_ISA::Pack::lanes;
};
template <> CRESCENT_ALWAYS_INLINE CRESCENT_ISA::Pack from_bits<CRESCENT_ISA::Pack>(CRESCENT_ISA::Uint u) {
    using namespace CRESCENT_ISA;
    return {hn::BitCast(FloatTag{}, u.a), hn::BitCast(FloatTag{}, u.b)};
}
template <> CRESCENT_ALWAYS_INLINE CRESCENT_ISA::Pack to_float<CRESCENT_ISA::Pack>(CRESCENT_ISA::Uint u) {
    using namespace CRESCENT_ISA;
    const hn::RebindToSigned<FloatTag> tag;
    return {hn::ConvertTo(FloatTag{}, hn::BitCast(tag, u.a)), hn::ConvertTo(FloatTag{}, hn::BitCast(tag, u.b))};
}
template <> CRESCENT_ALWAYS_INLINE CRESCENT_ISA::Pack load_as<CRESCENT_ISA::Pack>(const float* p) {
    using namespace CRESCENT_ISA;
    return {hn::LoadU(FloatTag{}, p), hn::LoadU(FloatTag{}, p + half_lanes)};
}
template <> CRESCENT_ALWAYS_INLINE CRESCENT_ISA::Uint load_as<CRESCENT_ISA::Uint>(const std::uint32_t* p) {
    using namespace CRESCENT_ISA;
    return {hn::LoadU(UintTag{}, p), hn::LoadU(UintTag{}, p + half_lanes)};
}

}  // namespace crescent
