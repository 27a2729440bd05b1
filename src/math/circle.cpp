// sin, cos, their inverses and lengths, see functions.h.
//
//   x = n pi/2 + r, |r| <= pi/4, r in two doubles; then the series of sin and cos.
//   atan(y/x) = atan c + atan t,  t = (y - c x)/(x + c y),  c = j/16 the nearest to y/x <= 1: a table and seven terms.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "math/functions.h"
#include "math/two.h"

namespace crescent::math {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
constexpr Two pi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr Two half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr double third_of_half_pi = -0x1.f1976b7ed8fbcp-110;  // what pi/2 has beyond half_pi
// pi/2 once more: 33 bits, 32 bits, the rest.
constexpr double upper = 0x1.921fb544p+0, middle = 0x1.0b4611a6p-34, lower = 0x1.3198a2e037073p-69;
constexpr double round_magic = 0x1.8p52;

/// x = n pi/2 + r, n modulo 4.
struct Reduced {
    unsigned n;
    Two r;
};

Reduced reduce(double x) {
    if (std::fabs(x) <= 0.785) return {0, {x, 0}};
    const double shifted = x * (1 / half_pi.hi) + round_magic, n = shifted - round_magic;
    const auto quarter = static_cast<unsigned>(std::bit_cast<std::uint64_t>(shifted) & 3u);
    if (std::fabs(x) < 0x1p20) {
        const double a = x - n * upper, b = n * middle, r = a - b;  // the products are exact, and a is
        if (std::fabs(r) > 0x1p-10) {
            const double rest = ((a - r) - b) - n * lower;
            return {quarter, ordered_sum(r, rest)};
        }
    }
    const Two p = product(n, half_pi.hi), q = product(n, half_pi.lo);  // much cancels, or x is large
    return {quarter, Two{x - p.hi, 0} + -p.lo + -q.hi + (-q.lo - n * third_of_half_pi)};
}

/// sin r for |r| <= pi/4.
double sin_series(Two r) {
    if (r.hi == 0) return r.hi;  // -0 stays
    const double z = r.hi * r.hi, w = z * z;
    const double even = -1.0 / 6 + w * (-1.0 / 5040 + w * (-1.0 / 39916800 + w * (-1.0 / 1307674368000)));
    const double odd = 1.0 / 120 + w * (1.0 / 362880 + w * (1.0 / 6227020800 + w * (1.0 / 355687428096000)));
    return r.hi + (r.lo * (1 - 0.5 * z) + r.hi * z * (even + z * odd));
}

/// cos r for |r| <= pi/4.
double cos_series(Two r) {
    const double z = r.hi * r.hi, w = z * z, half = 0.5 * z, top = 1 - half;
    const double even = 1.0 / 24 + w * (1.0 / 40320 + w * (1.0 / 479001600 + w * (1.0 / 20922789888000)));
    const double odd = -1.0 / 720 + w * (-1.0 / 3628800 + w * (-1.0 / 87178291200));
    return top + (((1 - top) - half) + (w * (even + z * odd) - r.hi * r.lo));
}

/// atan(j/16), Euler's series: sum of 2^2n n!^2/(2n+1)! c^(2n+1)/(1+c^2)^(n+1).
constexpr auto angles = [] {
    std::array<Two, 17> table{};
    for (int j = 1; j <= 16; ++j) {
        const Two c = {j / 16.0, 0}, c2 = c * c, over = c2 + 1.0, ratio = c2 / over;
        Two term = c / over, sum = term;
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
    const double even = -1.0 / 3 + w * (-1.0 / 7 + w * (-1.0 / 11 + w * (-1.0 / 15)));
    const double odd = 1.0 / 5 + w * (1.0 / 9 + w * (1.0 / 13));
    const Two at_c = angles[static_cast<std::size_t>(static_cast<int>(16 * c))];
    return at_c.hi + (t + (at_c.lo + t * z * (even + z * odd)));
}

/// The angle of (x, y) from the x axis, y >= 0: [0, pi].
double angle(double y, double x) {
    const double ahead = std::fabs(x);
    const double a = y > ahead ? half_pi.hi - (first_octant(ahead, y) - half_pi.lo) : first_octant(y, ahead);
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

/// A power of 2 that brings v > 0 near 1, or as near as a power of 2 can.
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
    const Reduced at = reduce(x);
    const double s = sin_series(at.r), c = cos_series(at.r);
    switch (at.n) {
        case 0: return {s, c};
        case 1: return {c, -s};
        case 2: return {-s, -c};
        default: return {-c, s};
    }
}

double sin(double x) {
    if (!(std::fabs(x) < 0x1p50)) return none;
    const Reduced at = reduce(x);
    const double v = at.n & 1 ? cos_series(at.r) : sin_series(at.r);
    return at.n & 2 ? -v : v;
}

double cos(double x) {
    if (!(std::fabs(x) < 0x1p50)) return none;
    const Reduced at = reduce(x);
    const double v = at.n & 1 ? sin_series(at.r) : cos_series(at.r);
    return (at.n + 1) & 2 ? -v : v;
}

double tan(double x) {
    const SinCos at = sincos(x);
    return at.sin / at.cos;
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
    if (ay == 0 || ax == infinity || ay == infinity || ax == 0) {  // on an axis, or as good as
        const bool corner = ax == infinity && ay == infinity, along_x = ay == 0 || (ax == infinity && !corner);
        const double lies = corner ? 0.25 * pi.hi : along_x ? 0 : half_pi.hi;
        const double behind = corner ? 0.75 * pi.hi : pi.hi - lies;
        return std::copysign(std::signbit(x) ? behind : lies, y);
    }
    const double larger = ax > ay ? ax : ay, scale = scale_of(larger);
    const double sy = ay * scale;
    ax *= scale;
    if (ax > 0 && sy / ax < 0x1p-400 && x > 0) return y / x;  // the angle is the quotient, whatever it rounds to
    return std::copysign(angle(sy, std::copysign(ax, x)), y);
}

double hypot(double x, double y) { return hypot(x, y, 0); }

double hypot(double x, double y, double z) {
    x = std::fabs(x), y = std::fabs(y), z = std::fabs(z);
    if (x == infinity || y == infinity || z == infinity) return infinity;
    const double xy = x > y ? x : y, largest = xy > z ? xy : z;
    if (largest == 0 || x != x || y != y || z != z) return x + y + z;
    const double scale = scale_of(largest);
    const double a = x * scale, b = y * scale, c = z * scale;
    return root(product(a, a) + product(b, b) + product(c, c)).hi / scale;
}

}  // namespace crescent::math
