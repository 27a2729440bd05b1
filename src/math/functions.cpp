// sin, cos, their inverses and lengths, see functions.h.
//
//   x = n pi/2 + r, |r| <= pi/4, r in two doubles; then the series of sin and cos.
//   atan(y/x) = atan c + atan t,  t = (y - c x)/(x + c y),  c = j/16 the nearest to y/x <= 1: a table and seven terms.
#include "math/functions.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace crescent::math {

// ---- A number kept in two doubles, hi + lo with |lo| <= ulp(hi) / 2: about 106 bits, for values that functions.h must
// not round.
//
// T. J. Dekker 1971, "A floating-point technique for extending the available precision", Numer. Math. 18, and D. E.
// Knuth, TAOCP 2, 4.2.2: exact sums and products of two doubles, from + - x alone. Everything here is constexpr: the
// compiler sums the series of the tables of functions.h.

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

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
constexpr Two pi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr Two half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr double third_of_half_pi = -0x1.f1976b7ed8fbcp-110;  // the part of pi/2 beyond half_pi
// pi/2 in parts: 33 bits, 32 bits, the rest.
constexpr double upper = 0x1.921fb544p+0, middle = 0x1.0b4611a6p-34, lower = 0x1.3198a2e037073p-69;
constexpr double round_magic = 0x1.8p52;

/// x = n pi/2 + r, n modulo 4.
struct Reduced {
    unsigned n;
    Two r;
};

Reduced reduce(double x) {
    if (std::fabs(x) <= 0.785) return {0, {x, 0}};
    const double magic_sum = x * (1 / half_pi.hi) + round_magic, n = magic_sum - round_magic;
    const auto quarter = static_cast<unsigned>(std::bit_cast<std::uint64_t>(magic_sum) & 3u);
    if (std::fabs(x) < 0x1p20) {
        const double a = x - n * upper, b = n * middle, r = a - b;  // the products are exact, and a is
        if (std::fabs(r) > 0x1p-10) {
            const double remainder = ((a - r) - b) - n * lower;
            return {quarter, ordered_sum(r, remainder)};
        }
    }
    const Two p = product(n, half_pi.hi), q = product(n, half_pi.lo);  // much cancels, or x is large
    return {quarter, Two{x - p.hi, 0} + -p.lo + -q.hi + (-q.lo - n * third_of_half_pi)};
}

/// sin r for |r| <= pi/4.
double sin_series(Two r) {
    if (r.hi == 0) return r.hi;  // keeps -0
    const double z = r.hi * r.hi, w = z * z;
    const double even_terms = -1.0 / 6 + w * (-1.0 / 5040 + w * (-1.0 / 39916800 + w * (-1.0 / 1307674368000)));
    const double odd_terms = 1.0 / 120 + w * (1.0 / 362880 + w * (1.0 / 6227020800 + w * (1.0 / 355687428096000)));
    return r.hi + (r.lo * (1 - 0.5 * z) + r.hi * z * (even_terms + z * odd_terms));
}

/// cos r for |r| <= pi/4.
double cos_series(Two r) {
    const double z = r.hi * r.hi, w = z * z, half = 0.5 * z, top = 1 - half;
    const double even_terms = 1.0 / 24 + w * (1.0 / 40320 + w * (1.0 / 479001600 + w * (1.0 / 20922789888000)));
    const double odd_terms = -1.0 / 720 + w * (-1.0 / 3628800 + w * (-1.0 / 87178291200));
    return top + (((1 - top) - half) + (w * (even_terms + z * odd_terms) - r.hi * r.lo));
}

/// atan(j/16), Euler's series: sum of 2^2n n!^2/(2n+1)! c^(2n+1)/(1+c^2)^(n+1).
constexpr auto angles = [] {
    std::array<Two, 17> table{};
    for (int j = 1; j <= 16; ++j) {
        const Two c = {j / 16.0, 0}, c2 = c * c, denominator = c2 + 1.0, ratio = c2 / denominator;
        Two term = c / denominator, sum = term;
        for (int n = 1; n < 110; ++n) {
            term = term * ratio * (2.0 * n) / Two{2.0 * n + 1, 0};
            sum = sum + term;
        }
        table[static_cast<std::size_t>(j)] = sum;
    }
    return table;
}();

/// a without its lower 27 (or more) bits.
double upper_part(double a) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(a) & (~std::uint64_t{0} << 27));
}

/// atan(y/x) for 0 <= y <= x, x > 0. c has 4 bits: its products with either half of x are exact.
double first_octant(double y, double x) {
    const double ratio = y / x, c = ratio < 1.5 / 16 ? 0 : ((16 * ratio + round_magic) - round_magic) / 16;
    const double high = upper_part(x);
    const double t = c == 0 ? ratio : ((y - c * high) - c * (x - high)) / (x + c * y);
    const double z = t * t, w = z * z;
    const double even_terms = -1.0 / 3 + w * (-1.0 / 7 + w * (-1.0 / 11 + w * (-1.0 / 15)));
    const double odd_terms = 1.0 / 5 + w * (1.0 / 9 + w * (1.0 / 13));
    const Two at_c = angles[static_cast<std::size_t>(static_cast<int>(16 * c))];
    return at_c.hi + (t + (at_c.lo + t * z * (even_terms + z * odd_terms)));
}

/// The angle of (x, y) from the x axis, y >= 0: [0, pi].
double angle(double y, double x) {
    const double ax = std::fabs(x);
    const bool steep = y > ax;
    const double in_octant = first_octant(steep ? ax : y, steep ? y : ax);
    const double a = steep ? half_pi.hi - (in_octant - half_pi.lo) : in_octant;
    return x < 0 ? pi.hi - (a - pi.lo) : a;
}

/// sqrt(a) for a >= 0 (Newton's step on the rounded root).
Two root(Two a) {
    if (!(a.hi > 0)) return {0, 0};
    const double s = std::sqrt(a.hi);
    const Two p = product(s, s);
    return ordered_sum(s, (((a.hi - p.hi) - p.lo) + a.lo) / (2 * s));
}

double other_side(double x) { return std::sqrt((1 - x) * (1 + x)); }

/// Returns a power of 2 that brings v > 0 near 1, as far as possible.
double scale_of(double v) {
    const std::uint64_t exponent = std::bit_cast<std::uint64_t>(v) >> 52;
    return std::bit_cast<double>((exponent > 2040       ? std::uint64_t{6}
                                         : exponent < 6 ? std::uint64_t{2040}
                                                        : 2046 - exponent)
        << 52);
}

}  // namespace

SinCos sincos(double x) {
    if (!(std::fabs(x) < 0x1p50)) return {none, none};
    const Reduced reduction = reduce(x);
    const double s = sin_series(reduction.r), c = cos_series(reduction.r);
    // (s, c), (c, -s), (-s, -c), (-c, s) for n = 0 to 3, without a branch: n is random in most uses.
    const auto n = static_cast<std::uint64_t>(reduction.n), exchanged = -(n & 1);
    const auto bits_s = std::bit_cast<std::uint64_t>(s), bits_c = std::bit_cast<std::uint64_t>(c);
    const std::uint64_t swap_bits = (bits_s ^ bits_c) & exchanged;
    return {std::bit_cast<double>(bits_s ^ swap_bits ^ (n >> 1) << 63),
        std::bit_cast<double>(bits_c ^ swap_bits ^ ((n ^ n >> 1) & 1) << 63)};
}

double sin(double x) {
    if (!(std::fabs(x) < 0x1p50)) return none;
    const Reduced reduction = reduce(x);
    const double v = reduction.n & 1 ? cos_series(reduction.r) : sin_series(reduction.r);
    return reduction.n & 2 ? -v : v;
}

double cos(double x) {
    if (!(std::fabs(x) < 0x1p50)) return none;
    const Reduced reduction = reduce(x);
    const double v = reduction.n & 1 ? sin_series(reduction.r) : cos_series(reduction.r);
    return (reduction.n + 1) & 2 ? -v : v;
}

double tan(double x) {
    const SinCos values = sincos(x);
    return values.sin / values.cos;
}

double asin(double x) {
    if (!(std::fabs(x) <= 1)) return none;
    if (std::fabs(x) < 0x1p-27) return x;
    return std::copysign(angle(std::fabs(x), other_side(x)), x);
}

double acos(double x) { return std::fabs(x) <= 1 ? angle(other_side(x), x) : none; }

double atan2(double y, double x) {
    if (x != x || y != y) return none;
    const double ay = std::fabs(y);
    double ax = std::fabs(x);
    if (ay == 0 || ax == infinity || ay == infinity || ax == 0) {  // on an axis, up to rounding
        const bool corner = ax == infinity && ay == infinity, along_x = ay == 0 || (ax == infinity && !corner);
        const double front_angle = corner ? 0.25 * pi.hi : along_x ? 0 : half_pi.hi;
        const double back_angle = corner ? 0.75 * pi.hi : pi.hi - front_angle;
        return std::copysign(std::signbit(x) ? back_angle : front_angle, y);
    }
    const double larger = ax > ay ? ax : ay, scale = scale_of(larger);
    const double sy = ay * scale;
    ax *= scale;
    if (ax > 0 && sy / ax < 0x1p-400 && x > 0) return y / x;  // the angle is the quotient, with any rounding
    return std::copysign(angle(sy, std::copysign(ax, x)), y);
}

double hypot(double x, double y) { return hypot(x, y, 0); }

double hypot(double x, double y, double z) {
    x = std::fabs(x);
    y = std::fabs(y);
    z = std::fabs(z);
    if (x == infinity || y == infinity || z == infinity) return infinity;
    const double xy = x > y ? x : y, largest = xy > z ? xy : z;
    if (largest == 0 || x != x || y != y || z != z) return x + y + z;
    const double scale = scale_of(largest);
    const double a = x * scale, b = y * scale, c = z * scale;
    return root(product(a, a) + product(b, b) + product(c, c)).hi / scale;
}

// ---- exp, log and related functions, see functions.h.
//
//   e^x = 2^(k/32) e^r,  |r| <= ln 2 / 64:  a table of 2^(j/32) and six terms of the series.
//   ln x = e ln 2 + ln c + 2 (s + s^3/3 + s^5/5 + ...),  s = (m - c)/(m + c),  x = 2^e m, c = j/32 the nearest to m.

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr Two ln2 = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
constexpr double ln2_upper = 0x1.62e42fefap-1;       // 36 bits of it: its product with an integer < 2^17 is exact
constexpr double ln2_lower = 0x1.cf79abc9e3b3ap-40;  // and the rest
constexpr Two inverse_ln10 = {0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57};
constexpr double whole_magic = 0x1.8p52;  // adding and subtracting it rounds to an integer
constexpr int steps = 32;

/// 2^(j/32): e^x = sum of x^k / k!.
constexpr auto roots = [] {
    std::array<Two, steps> table{};
    for (int j = 0; j < steps; ++j) {
        const Two x = ln2 * (j / double(steps));
        Two term = {1, 0}, sum = term;
        for (int k = 1; k < 32; ++k) sum = sum + (term = term * x / Two{double(k), 0});
        table[static_cast<std::size_t>(j)] = sum;
    }
    return table;
}();

/// ln(j/32) for c = j/32 from 22/32 to 46/32: 2 atanh((c - 1)/(c + 1)).
constexpr int first_log = 22;
constexpr auto logs = [] {
    std::array<Two, 25> table{};
    for (int i = 0; i < 25; ++i) {
        const int j = first_log + i;
        const Two s = Two{double(j - steps), 0} / Two{double(j + steps), 0}, z = s * s;
        Two term = s, sum = s;
        for (int k = 3; k < 50; k += 2) sum = sum + (term = term * z) / Two{double(k), 0};
        table[static_cast<std::size_t>(i)] = sum * 2.0;
    }
    return table;
}();

double power_of_2(std::int64_t e) { return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52); }

/// e^r - 1 for |r| <= ln 2 / 64.
double growth(double r) {
    const double z = r * r;
    return r + z * ((1.0 / 2 + r * (1.0 / 6)) + z * ((1.0 / 24 + r * (1.0 / 120)) + z * (1.0 / 720)));
}

/// e^x as 2^exponent (root + root p).
struct Exponential {
    std::int64_t exponent;
    Two root;
    double p;
    /// Scales in two steps if 2^exponent alone is outside the range of double.
    double scale(double value) const {
        if (exponent > -1022 && exponent < 1024) return value * power_of_2(exponent);
        const std::int64_t half = exponent / 2;
        return value * power_of_2(half) * power_of_2(exponent - half);
    }
    double value() const { return scale(root.hi + (root.lo + root.hi * p)); }
};

/// k in 1/32 of a power of 2, r the remainder.
Exponential exponential(double k, double r) {
    const auto integer = static_cast<std::int64_t>(k);
    return {integer >> 5, roots[static_cast<std::size_t>(integer & (steps - 1))], growth(r)};
}

/// e^(x + remainder) for |x| < 750.
Exponential exponential_of(double x, double remainder) {
    const double k = (x * (steps / ln2.hi) + whole_magic) - whole_magic;
    return exponential(k, ((x - k * (ln2_upper / steps)) - k * (ln2_lower / steps)) + remainder);
}

double exp(Two x) {
    if (x.hi > 710) return unbounded;
    if (x.hi < -746) return 0;
    return exponential_of(x.hi, x.lo).value();
}

/// a without its lower 27 (or more) bits.
template <int bits = 27> double upper_part(double a) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(a) & (~std::uint64_t{0} << bits));
}

/// s = (m - c + remainder)/(m + c + remainder), to twice the bits of a double: a rounded quotient and what remains, in
/// products short enough to be exact.
template <bool with_remainder> Two quotient(double m, double c, double remainder) {
    const double d = m - c, high = upper_part(m) + c;
    double low = m - upper_part(m), small = 0;
    Two numerator = {d, 0};
    if constexpr (with_remainder) {
        numerator = sum(d, remainder);
        low += remainder;
        small = numerator.lo;
    }
    const double inverse = 1 / (high + low), s = upper_part<29>(numerator.hi * inverse);
    return {s, (((numerator.hi - s * high) - s * low) + small) * inverse};
}

/// x = 2^e m, c the multiple of 1/32 next to m, logs[row] its logarithm.
struct Parts {
    double m, c, e;
    std::size_t row;
    std::int64_t exponent;
};
Parts parts_of(double x) {
    constexpr std::uint64_t lowest = std::bit_cast<std::uint64_t>(0x1.6a09e667f3bcdp-1);  // sqrt(1/2)
    double scale = 0;
    if (x < 0x1p-1022) {
        x *= 0x1p54;
        scale = 54;
    }
    const std::uint64_t t = std::bit_cast<std::uint64_t>(x) - lowest;
    const auto exponent = static_cast<std::int64_t>(t) >> 52;
    const double m = std::bit_cast<double>((t & 0xfffffffffffffu) + lowest);
    const double nearest = (m * steps + whole_magic) - whole_magic;
    const auto row = static_cast<std::size_t>(static_cast<int>(nearest) - first_log);
    return {.m = m, .c = nearest / steps, .e = static_cast<double>(exponent) - scale, .row = row, .exponent = exponent};
}

/// 2 (s^3/3 + s^5/5 + ...) for |s| < 1/80.
double tail_of(double s) {
    const double z = s * s;
    return s * z * ((2.0 / 3 + z * (2.0 / 5)) + z * z * ((2.0 / 7 + z * (2.0 / 9)) + z * z * (2.0 / 11)));
}

/// ln(x + remainder) for x > 0 and |remainder| <= ulp(x)/2, to some 2^-66 of itself.
template <bool with_remainder> Two logarithm(double x, double remainder = 0) {
    const Parts parts = parts_of(x);
    if constexpr (with_remainder) {
        const std::int64_t half = -parts.exponent / 2;
        remainder = remainder * power_of_2(half) * power_of_2(-parts.exponent - half);
    }
    const Two log_c = logs[parts.row], s = quotient<with_remainder>(parts.m, parts.c, remainder);
    const Two base = ordered_sum(parts.e * ln2_upper, log_c.hi), total = ordered_sum(base.hi, 2 * s.hi);
    const double small = (parts.e * ln2_lower + log_c.lo) + (2 * s.lo + tail_of(s.hi + s.lo));
    return ordered_sum(total.hi, total.lo + (base.lo + small));
}

/// Returns the special values of a logarithm: at 0, infinity and NaN.
bool has_logarithm(double x, double& otherwise) {
    otherwise = x == 0 ? -unbounded : x > 0 ? x : no_number;
    return x > 0 && x < unbounded;
}

}  // namespace

double exp(double x) { return x == x ? exp(Two{x, 0}) : x; }

double exp2(double x) {
    if (!(x < 1025)) return x == x ? unbounded : x;
    if (x < -1080) return 0;
    const double k = (x * steps + whole_magic) - whole_magic;
    return exponential(k, (x - k / steps) * ln2.hi).value();
}

double expm1(double x) {
    if (!(x < 710)) return x == x ? unbounded : x;
    if (x < -40) return -1;
    if (std::fabs(x) < 0.1) {
        if (x == 0) return x;  // keeps -0
        const double z = x * x;
        const double odd_terms = 1.0 / 6 + z * (1.0 / 120 + z * (1.0 / 5040 + z * (1.0 / 362880)));
        const double even_terms = 1.0 / 24 + z * (1.0 / 720 + z * (1.0 / 40320 + z * (1.0 / 3628800)));
        return x + (0.5 * z + z * (x * odd_terms + z * even_terms));
    }
    const Exponential e = exponential_of(x, 0);
    if (e.exponent > 60) return e.value();
    const double scale = power_of_2(e.exponent);
    const Two difference = sum(scale * e.root.hi, -1);
    return difference.hi + (difference.lo + scale * (e.root.lo + e.root.hi * e.p));
}

namespace {

/// ln(x + remainder), remainder at most ulp(x)/2.
double rounded_logarithm(double x, double remainder) {
    const Parts parts = parts_of(x);
    if (std::fabs(parts.m - 1) < 0.05) {  // small against its own terms
        return (remainder != 0 ? logarithm<true>(x, remainder) : logarithm<false>(x)).hi;
    }
    const Two log_c = logs[parts.row];
    const double s = (parts.m - parts.c) / (parts.m + parts.c);
    const Two base = ordered_sum(parts.e * ln2_upper, log_c.hi);
    const double small = parts.e * ln2_lower + log_c.lo + tail_of(s);
    return base.hi + (2 * s + (base.lo + (remainder != 0 ? small + remainder / x : small)));
}

}  // namespace

double log(double x) {
    double otherwise;
    return has_logarithm(x, otherwise) ? rounded_logarithm(x, 0) : otherwise;
}

double log10(double x) {
    double otherwise;
    return has_logarithm(x, otherwise) ? (logarithm<false>(x) * inverse_ln10).hi : otherwise;
}

double log1p(double x) {
    double otherwise;
    if (std::fabs(x) < 0x1p-54) return x;
    const Two y = sum(1, x);
    return has_logarithm(y.hi, otherwise) ? rounded_logarithm(y.hi, y.lo) : x == unbounded ? x : otherwise;
}

double pow(double x, double y) {
    if (y == 0 || x == 1) return 1;
    if (x != x || y != y) return no_number;
    double sign = 1;
    if (std::signbit(x)) {
        const bool is_integer = std::trunc(y) == y;
        if (x < 0 && !is_integer) return x == -unbounded ? (y < 0 ? 0 : unbounded) : no_number;
        if (is_integer && std::fabs(y) < 0x1p53 && std::fmod(y, 2) != 0) sign = -1;
        x = -x;
    }
    if (x == 0 || x == unbounded) return sign * ((x == 0) == (y < 0) ? unbounded : 0.0);
    if (x == 1) return sign;
    const double clamped_y = y > 0x1p80 ? 0x1p80 : y < -0x1p80 ? -0x1p80 : y;  // outside, every result is 0 or infinite
    return sign * exp(logarithm<false>(x) * clamped_y);
}

}  // namespace crescent::math
