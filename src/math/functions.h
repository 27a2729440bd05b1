// Elementary functions of doubles from + - x / and sqrt alone, so that they have the same bits on every machine: a C
// library selects its own by the processor, and the last bit differs.
//
//   function        range                        error, ULP (bounds that functions_test.cpp tests)
//   exp             all; > 0 from -745 on        0.54
//   exp2            all                          0.54
//   expm1           all                          0.75
//   log             x > 0                        0.9
//   log10           x > 0                        0.51
//   log1p           x > -1                       0.9
//   pow             all                          0.75
//   whole_power     n >= 1                       n
//   sin, cos        |x| < 2^50, else NaN         0.8
//   tan             |x| < 2^50, else NaN         2
//   atan2           all                          1.25
//   asin, acos      [-1, 1], else NaN            2
//   hypot           all                          0.51
//
// An ULP is that of the exact value; a value below 2^-1022 may be off by one of 2^-1074 more. Zeros, infinities and NaN
// are handled as in C.
//
// Each is one step of a table and a short series whose coefficients are 1/k! or 1/k; tables and values that must not be
// rounded are kept in two doubles (`Two` in functions.cpp).
#pragma once

#include <cmath>

#include "base/vec.h"

namespace crescent::math {

/// e^x and 2^x; infinity above the largest double, 0 below the smallest.
double exp(double x);
double exp2(double x);
/// e^x - 1 without cancellation near 0.
double expm1(double x);

/// The natural and the decimal logarithm; NaN for x < 0, -infinity at 0.
double log(double x);
double log10(double x);
/// log(1 + x) without cancellation near 0.
double log1p(double x);

/// x^y; a negative x has a power only for integer y.
double pow(double x, double y);
/// x^n by squaring: for small n it is many times as fast as pow().
constexpr double whole_power(double x, unsigned n) {
    double out = n & 1u ? x : 1;
    for (n >>= 1; n > 0; n >>= 1) {
        x *= x;
        if (n & 1u) out *= x;
    }
    return out;
}

/// Of x in radians.
double sin(double x);
double cos(double x);
double tan(double x);
struct SinCos {
    double sin, cos;
};
/// Both, for little more than the cost of one.
SinCos sincos(double x);

/// Inverse sine and cosine, radians; NaN outside [-1, 1].
double asin(double x);
double acos(double x);
/// The angle of (x, y) from the x axis, in [-pi, pi].
double atan2(double y, double x);

/// The length of a vector, without intermediate overflow.
double hypot(double x, double y);
double hypot(double x, double y, double z);

// ---- Unit vectors by their angles about z: theta from z, phi from x towards y, in radians.

/// The vector of sin theta, cos theta and phi.
inline Vec3d spherical(double sin, double cos, double phi) {
    const SinCos azimuth = sincos(phi);
    return {sin * azimuth.cos, sin * azimuth.sin, cos};
}
/// The vector of cos theta, in [-1, 1] up to rounding, and phi.
inline Vec3d spherical(double cos, double phi) {
    const double squared = 1 - cos * cos;
    return spherical(std::sqrt(squared > 0 ? squared : 0), cos, phi);
}

}  // namespace crescent::math
