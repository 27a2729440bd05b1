// A number kept in two doubles, hi + lo with |lo| <= ulp(hi) / 2: about 106 bits, for values that functions.h must not
// round.
//
// T. J. Dekker 1971, "A floating-point technique for extending the available precision", Numer. Math. 18, and D. E.
// Knuth, TAOCP 2, 4.2.2: exact sums and products of two doubles, from + - x alone. Everything here is constexpr: the
// compiler sums the series of the tables of functions.h.
#pragma once

namespace crescent::math {

struct Two {
    double hi, lo;
};

/// Returns a + b exactly, for |a| >= |b| or a = 0 (Dekker).
constexpr Two ordered_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
}

/// Returns a + b exactly (Knuth).
constexpr Two sum(double a, double b) {
    const double s = a + b, from_b = s - a;
    return {s, (a - (s - from_b)) + (b - from_b)};
}

/// Veltkamp: the upper 26 bits of a and the rest; |a| < 2^996.
constexpr Two halves(double a) {
    const double c = 134217729.0 * a;  // 2^27 + 1
    const double hi = c - (c - a);
    return {hi, a - hi};
}

/// Returns a b exactly if nothing overflows and the low part is not below 2^-1022 (Dekker).
constexpr Two product(double a, double b) {
    const double p = a * b;
    const Two x = halves(a), y = halves(b);
    return {p, ((x.hi * y.hi - p) + x.hi * y.lo + x.lo * y.hi) + x.lo * y.lo};
}

constexpr Two operator-(Two a) { return {-a.hi, -a.lo}; }
constexpr Two operator+(Two a, double b) {
    const Two s = sum(a.hi, b);
    return ordered_sum(s.hi, s.lo + a.lo);
}
constexpr Two operator+(Two a, Two b) {
    const Two s = sum(a.hi, b.hi), t = sum(a.lo, b.lo);
    const Two u = ordered_sum(s.hi, s.lo + t.hi);
    return ordered_sum(u.hi, u.lo + t.lo);
}
constexpr Two operator-(Two a, Two b) { return a + -b; }
constexpr Two operator*(Two a, double b) {
    const Two p = product(a.hi, b);
    return ordered_sum(p.hi, p.lo + a.lo * b);
}
constexpr Two operator*(Two a, Two b) {
    const Two p = product(a.hi, b.hi);
    return ordered_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}
/// Divides the leading parts, and then the remainder.
constexpr Two operator/(Two a, Two b) {
    const double inverse = 1 / b.hi, q = a.hi * inverse;
    const Two p = product(q, b.hi);
    return ordered_sum(q, ((((a.hi - p.hi) - p.lo) + a.lo) - q * b.lo) * inverse);
}

}  // namespace crescent::math
