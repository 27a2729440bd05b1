// exp, log and their kin, see functions.h.
//
//   e^x = 2^(k/32) e^r,  |r| <= ln 2 / 64:  a table of 2^(j/32) and six terms of the series.
//   ln x = e ln 2 + ln c + 2 (s + s^3/3 + s^5/5 + ...),  s = (m - c)/(m + c),  x = 2^e m, c = j/32 the nearest to m.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "math/functions.h"
#include "math/two.h"

namespace crescent::math {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr Two ln2 = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
constexpr double ln2_upper = 0x1.62e42fefap-1;       // 36 bits of it: times a whole number < 2^17 it is exact
constexpr double ln2_lower = 0x1.cf79abc9e3b3ap-40;  // and the rest
constexpr Two inverse_ln10 = {0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57};
constexpr double whole_magic = 0x1.8p52;  // adding and subtracting it rounds to a whole number
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
    /// Where 2^exponent alone is more or less than a double holds: in two steps.
    double scaled(double value) const {
        if (exponent > -1022 && exponent < 1024) return value * power_of_2(exponent);
        const std::int64_t half = exponent / 2;
        return value * power_of_2(half) * power_of_2(exponent - half);
    }
    double value() const { return scaled(root.hi + (root.lo + root.hi * p)); }
};

/// k in 1/32 of a power of 2, r what is left.
Exponential exponential(double k, double r) {
    const auto whole = static_cast<std::int64_t>(k);
    return {whole >> 5, roots[static_cast<std::size_t>(whole & (steps - 1))], growth(r)};
}

/// e^(x + rest) for |x| < 750.
Exponential exponential_of(double x, double rest) {
    const double k = (x * (steps / ln2.hi) + whole_magic) - whole_magic;
    return exponential(k, ((x - k * (ln2_upper / steps)) - k * (ln2_lower / steps)) + rest);
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

/// s = (m - c + rest)/(m + c + rest), to twice the bits of a double: a rounded quotient and what it leaves over, in
/// products so short that they are exact.
template <bool with_rest> Two quotient(double m, double c, double rest) {
    const double d = m - c, high = upper_part(m) + c;
    double low = m - upper_part(m), small = 0;
    Two over = {d, 0};
    if constexpr (with_rest) over = sum(d, rest), low += rest, small = over.lo;
    const double inverse = 1 / (high + low), s = upper_part<29>(over.hi * inverse);
    return {s, (((over.hi - s * high) - s * low) + small) * inverse};
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
    return {m, nearest / steps, static_cast<double>(exponent) - scale, row, exponent};
}

/// 2 (s^3/3 + s^5/5 + ...) for |s| < 1/80.
double tail_of(double s) {
    const double z = s * s;
    return s * z * ((2.0 / 3 + z * (2.0 / 5)) + z * z * ((2.0 / 7 + z * (2.0 / 9)) + z * z * (2.0 / 11)));
}

/// ln(x + rest) for x > 0 and |rest| <= ulp(x)/2, to some 2^-66 of itself.
template <bool with_rest> Two logarithm(double x, double rest = 0) {
    const Parts at = parts_of(x);
    if constexpr (with_rest) {
        const std::int64_t half = -at.exponent / 2;
        rest = rest * power_of_2(half) * power_of_2(-at.exponent - half);
    }
    const Two log_c = logs[at.row], s = quotient<with_rest>(at.m, at.c, rest);
    const Two whole = ordered_sum(at.e * ln2_upper, log_c.hi), all = ordered_sum(whole.hi, 2 * s.hi);
    const double small = (at.e * ln2_lower + log_c.lo) + (2 * s.lo + tail_of(s.hi + s.lo));
    return ordered_sum(all.hi, all.lo + (whole.lo + small));
}

/// What a logarithm is where there is none to compute: 0, infinity and what is no number.
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
        if (x == 0) return x;  // -0 stays
        const double z = x * x;
        const double odd = 1.0 / 6 + z * (1.0 / 120 + z * (1.0 / 5040 + z * (1.0 / 362880)));
        const double even = 1.0 / 24 + z * (1.0 / 720 + z * (1.0 / 40320 + z * (1.0 / 3628800)));
        return x + (0.5 * z + z * (x * odd + z * even));
    }
    const Exponential e = exponential_of(x, 0);
    if (e.exponent > 60) return e.value();
    const double scale = power_of_2(e.exponent);
    const Two rest = sum(scale * e.root.hi, -1);
    return rest.hi + (rest.lo + scale * (e.root.lo + e.root.hi * e.p));
}

namespace {

/// ln(x + rest), rest at most ulp(x)/2.
double rounded_logarithm(double x, double rest) {
    const Parts at = parts_of(x);
    if (std::fabs(at.m - 1) < 0.05) {  // small beside its own terms
        return (rest != 0 ? logarithm<true>(x, rest) : logarithm<false>(x)).hi;
    }
    const Two log_c = logs[at.row];
    const double s = (at.m - at.c) / (at.m + at.c);
    const Two whole = ordered_sum(at.e * ln2_upper, log_c.hi);
    const double more = at.e * ln2_lower + log_c.lo + tail_of(s);
    return whole.hi + (2 * s + (whole.lo + (rest != 0 ? more + rest / x : more)));
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
        const bool whole = std::trunc(y) == y;
        if (x < 0 && !whole) return x == -unbounded ? (y < 0 ? 0 : unbounded) : no_number;
        if (whole && std::fabs(y) < 0x1p53 && std::fmod(y, 2) != 0) sign = -1;
        x = -x;
    }
    if (x == 0 || x == unbounded) return sign * ((x == 0) == (y < 0) ? unbounded : 0.0);
    if (x == 1) return sign;
    const double within = y > 0x1p80 ? 0x1p80 : y < -0x1p80 ? -0x1p80 : y;  // beyond, every result is 0 or infinite
    return sign * exp(logarithm<false>(x) * within);
}

}  // namespace crescent::math
