// Elementary functions from + - x / and sqrt alone, so that every instruction set and compiler returns the same bits.
//   function        range                          error (bounds that math_isa_test.cpp tests on every instruction set)
//   sincos_turns    u in [0, 1]                    1.2e-7 absolute
//   exp2            x in [-126, 127]               1.5 ULP; 0 below -126
//   root            u in [2^-24, 1], y <= 1/2      2 + y |log2 u| ULP
//   pow             x in [0, 1], y in (0, 2^17]    3 ULP if the result > 2^-24, 12 ULP above 2^-126, else 0
//   one_minus       of root and power              5 ULP of 1 - x^y
//   log_one_minus   u in [0, 1 - 2^-24], of 24 bits  3 ULP
//   cosine_power    unit a, b; s up to 10^6        3 + 4 s (1 - c)/c ULP of c^s, c = 1 - |a - b|^2 / 2
//   normalize       any finite a                   3 ULP per component
// On double the same names forward to math/functions.h, for quadrature and checks.
#pragma once
#include "base/vec.h"
#include "math/functions.h"
#include "math/simd/scalar.h"

namespace crescent {

template <class F> struct SinCos {
    F sin, cos;
};

/// Adding and subtracting 1.5 * 2^23 rounds |x| < 2^22 to the nearest integer, ties to even; its low bits are that
/// integer.
inline constexpr double round_magic = 12582912.0;

/// sin and cos of 2 pi u. Quarter turns are split off exactly; minimax polynomials on an eighth of a turn to either
/// side.
template <class F> CRESCENT_INLINE SinCos<F> sincos_turns(F u) {
    using U = UintOf<F>;
    const F magic = number<F>(round_magic);
    const F a = number<F>(4) * u;
    const F magic_sum = a + magic;
    const U quarter = bits(magic_sum);
    const F r = a - (magic_sum - magic);  // in quarter turns, [-1/2, 1/2]
    const F z = r * r;
    const F s = r *
        (number<F>(1.5707963220e+00) +
            z * (number<F>(-6.4596347991e-01) + z * (number<F>(7.9680238338e-02) + z * number<F>(-4.6022006005e-03))));
    const F c = number<F>(1) +
        z *
            (number<F>(-1.2337005494e+00) +
                z *
                    (number<F>(2.5366941067e-01) +
                        z * (number<F>(-2.0861531193e-02) + z * number<F>(9.0674695455e-04))));
    const auto swap = (quarter & U(1u)) == U(1u);
    const U sin_sign = shift_left<30>(quarter & U(2u));
    const U cos_sign = shift_left<30>((quarter + U(1u)) & U(2u));
    return {from_bits<F>(bits(select(swap, c, s)) ^ sin_sign), from_bits<F>(bits(select(swap, s, c)) ^ cos_sign)};
}

/// 2^x and 1 - 2^x, the latter without cancellation for x near 0.
template <class F> struct Power {
    F value, one_minus;
};

/// 2^(k + r) for r in [-1/2, 1/2] and the integer k in the low bits of `magic_sum` (k + 1.5 * 2^23 as a float).
template <class F> CRESCENT_INLINE Power<F> exp2_split(F magic_sum, F r) {
    using U = UintOf<F>;
    const F one = number<F>(1);
    const F r2 = r * r;  // Estrin's scheme shortens the chain of dependent operations
    const F low = number<F>(6.9314718803e-01) + r * number<F>(2.4022651084e-01);
    const F middle = number<F>(5.5503571055e-02) + r * number<F>(9.6180308269e-03);
    const F high = number<F>(1.3390866863e-03) + r * number<F>(1.5469717178e-04);
    const F q = r * (low + r2 * (middle + r2 * high));
    const F value = (one + q) * from_bits<F>(shift_left<23>(bits(magic_sum) + U(127u)));
    return {value, select(magic_sum == number<F>(round_magic), -q, one - value)};
}

template <class F> CRESCENT_INLINE F exp2(F x) {
    const F magic = number<F>(round_magic);
    const F exponent = larger(x, number<F>(-126));
    const F magic_sum = exponent + magic;
    return select(x >= number<F>(-126), exp2_split(magic_sum, exponent - (magic_sum - magic)).value, number<F>(0));
}

/// (log((1+s)/(1-s)) - 2s)/s for z = s^2 <= 0.03, from FreeBSD's e_logf.c (Remez, 2^-34).
template <class F> CRESCENT_INLINE F atanh_series(F z) {
    const F w = z * z;
    return z * (number<F>(0.66666662693) + w * number<F>(0.28498786688)) +
        w * (number<F>(0.40000972152) + w * number<F>(0.24279078841));
}

/// A number kept in two floats, hi with at most 12 significant bits.
template <class F> struct Split {
    F hi, lo;
};
template <class F> CRESCENT_INLINE F upper_half(F x) { return from_bits<F>(bits(x) & UintOf<F>(0xfffff000u)); }

/// log2(x) for normal x > 0 as hi + lo, accurate to about 2^-33 absolute. x - 1 is used if x is close to 1: pass a more
/// accurate value than the rounded x gives, if available. After FreeBSD's e_log2f.c (log(1+f) by atanh-like series in
/// f/(2+f), Remez), with f^2 split to keep precision for f near the ends.
template <class F> CRESCENT_INLINE Split<F> log2_split(F x, F x_minus_1) {
    using U = UintOf<F>;
    const U t = bits(x) + U(0x3f800000u - 0x3f3504f3u);  // mantissa range [sqrt(1/2), sqrt(2))
    const F e = to_float<F>(shift_right<23>(t)) - number<F>(127);
    const F m = from_bits<F>((t & U(0x007fffffu)) + U(0x3f3504f3u));
    const F f = select(e == number<F>(0), x_minus_1, m - number<F>(1));
    const F s = f / (number<F>(2) + f);
    const F z = s * s;
    const F R = atanh_series(z);
    const F fh = upper_half(f);
    const F half = number<F>(0.5);
    const F square_hi = half * fh * fh;
    const F square_lo = half * ((f - fh) * (f + fh));
    const F square = square_hi + square_lo;
    const F hi = upper_half(f - square);
    const F lo = ((f - hi) - square_hi) - square_lo + s * (square + R);
    const F a = hi * number<F>(1.4428710938);  // 1/ln 2 = 1.4428710938 (12 bits) - 1.7605285393e-04
    const F b = (lo + hi) * number<F>(-1.7605285393e-04) + lo * number<F>(1.4428710938);
    const F sum = e + a;
    const F remainder = select(e == number<F>(0), number<F>(0), a - (sum - e)) + b;
    const F top = upper_half(sum);
    return {top, (sum - top) + remainder};
}

/// log(1 - u) for u in [0, 1 - 2^-24], without cancellation for small u.
template <class F> CRESCENT_INLINE F log_one_minus(F u) {
    const Split<F> l = log2_split(number<F>(1) - u, number<F>(0) - u);
    return (l.hi + l.lo) * number<F>(0.69314718055994531);
}
/// The same in double.
inline double log_one_minus(double u) { return math::log1p(-u); }

/// x^y and 1 - x^y for x in [0, 1], y > 0, given x and x - 1; x <= 0 gives 0 (the clamp of a lobe), and so does a
/// result below 2^-126.
template <class F> CRESCENT_INLINE Power<F> power(F x, F x_minus_1, F y) {
    const F none = number<F>(0);
    const F tiny = number<F>(1.17549435e-38);  // smallest normal
    const auto positive = x > tiny;
    const Split<F> l = log2_split(select(positive, x, number<F>(1)), select(positive, x_minus_1, none));
    const F yh = upper_half(y);
    const F high = yh * l.hi;  // exact: 12 x 12 bits
    const F low = yh * l.lo + (y - yh) * (l.hi + l.lo);
    const auto in_range = positive & (high + low > number<F>(-126));
    const F h = select(in_range, high, none), low_part = select(in_range, low, none);
    const F magic = number<F>(round_magic);
    const F magic_sum = (h + low_part) + magic;
    const Power<F> p = exp2_split(magic_sum, (h - (magic_sum - magic)) + low_part);
    return {select(in_range, p.value, none), select(in_range, p.one_minus, number<F>(1))};
}
template <class F> CRESCENT_INLINE F pow(F x, F y) { return power(x, x - number<F>(1), y).value; }
/// x^y and 1 - x^y.
template <class F> CRESCENT_INLINE Power<F> power(F x, F y) { return power(x, x - number<F>(1), y); }

/// u^y and 1 - u^y for u in [2^-24, 1] and 0 < y <= 1/2, the inverse of a lobe's distribution. A plain log2 is
/// sufficient because a small y scales its error down: (2 + y |log2 u|) ULP.
template <class F> CRESCENT_INLINE Power<F> root(F u, F y) {
    using U = UintOf<F>;
    const U t = bits(u) + U(0x3f800000u - 0x3f3504f3u);  // mantissa range [sqrt(1/2), sqrt(2))
    const F e = to_float<F>(shift_right<23>(t)) - number<F>(127);
    const F f = from_bits<F>((t & U(0x007fffffu)) + U(0x3f3504f3u)) - number<F>(1);
    const F s = f / (number<F>(2) + f);
    const F z = s * s;
    const F R = atanh_series(z);
    const F square = number<F>(0.5) * f * f;
    const F l = f - (square - s * (square + R));  // FreeBSD e_logf.c
    const F x = y * (e + l * number<F>(1.44269504));
    const F magic_sum = x + number<F>(round_magic);
    return exp2_split(magic_sum, x - (magic_sum - number<F>(round_magic)));
}
/// The same in double.
inline Power<double> root(double u, double y) {
    const double l = y * math::log(u);
    return {math::exp(l), -math::expm1(l)};
}

/// (a.b)_+^s for unit a and b, through 1 - a.b = |a - b|^2 / 2, which keeps its precision where a sharp lobe peaks.
template <class F> CRESCENT_INLINE F cosine_power(Vec3<F> a, Vec3<F> b, F s) {
    const Vec3<F> d = a - b;
    const F cos_minus_1 = number<F>(-0.5) * dot(d, d);
    return power(number<F>(1) + cos_minus_1, cos_minus_1, s).value;
}

/// The functions above in double, for the reference and the checks.
inline SinCos<double> sincos_turns(double u) {
    const auto [sin, cos] = math::sincos(2 * pi * u);
    return {sin, cos};
}
/// 2^x and x^y; x <= 0 gives 0.
inline double exp2(double x) { return math::exp2(x); }
inline double pow(double x, double y) { return x > 0 ? math::pow(x, y) : 0.0; }
inline Power<double> power(double x, double y) {
    if (!(x > 0)) return {0, 1};
    const double l = y * math::log(x);
    return {math::exp(l), -math::expm1(l)};
}
/// (a.b)_+^s for unit a and b. Integer s up to 256 are powers by squaring, to s ULP of c^s.
inline double cosine_power(Vec3<double> a, Vec3<double> b, double s) {
    const Vec3<double> d = a - b;
    const double cos_minus_1 = -0.5 * dot(d, d);
    if (!(cos_minus_1 > -1)) return 0;
    if (s <= 256 && s == std::trunc(s)) return math::whole_power(1 + cos_minus_1, static_cast<unsigned>(s));
    return math::exp(s * math::log1p(cos_minus_1));
}

template <class F> CRESCENT_INLINE Vec3<F> normalize(Vec3<F> a) {
    const F inverse = number<F>(1) / sqrt(dot(a, a));
    return {a.x * inverse, a.y * inverse, a.z * inverse};
}
template <class F> CRESCENT_INLINE F length(Vec3<F> a) { return sqrt(dot(a, a)); }

}  // namespace crescent
