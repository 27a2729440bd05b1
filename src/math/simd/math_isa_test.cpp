// Every function of simd/math.h on every instruction set of this machine: within the error that its header states, and
// the same bits as on plain floats.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "math/simd/random.h"
#include "render/kernel.h"
#include "tests/support/math_table.h"

namespace crescent::test {

MathTable scalar_math() { return math_table<float>(); }

namespace math_isa_test {

constexpr std::size_t n = 1 << 16;
using Floats = std::vector<float>;

struct Set {
    std::string isa;
    MathTable math;
};
std::vector<Set> sets() {
    std::vector<Set> out;
    for (const std::string& isa : isas())
        out.push_back({isa,
            isa == "avx512"     ? avx512_math()
                : isa == "avx2" ? avx2_math()
                : isa == "sse4" ? sse4_math()
                                : scalar_math()});
    return out;
}

/// The k-th of n numbers: all multiples of 2^-24 near both ends, random ones between.
Floats unit_numbers(std::uint32_t seed) {
    Floats x(n);
    for (std::size_t k = 0; k < n; ++k) {
        const float step = static_cast<float>(k / 4 + 1) * 0x1p-24f;
        x[k] = k % 4 == 0 ? step : k % 4 == 1 ? 1 - step : draw(seed, 0, k).x;
    }
    return x;
}

double ulps(float got, long double want) {
    const float near = static_cast<float>(want);
    const float ulp = std::nextafter(std::fabs(near), INFINITY) - std::fabs(near);
    return static_cast<double>(std::fabs(static_cast<long double>(got) - want) / static_cast<long double>(ulp));
}

void expect_same_bits(const Floats& a, const Floats& b, const std::string& what) {
    std::size_t other = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        other += std::bit_cast<std::uint32_t>(a[k]) != std::bit_cast<std::uint32_t>(b[k]);
    EXPECT_EQ(other, 0u) << what;
}

/// Calls `run(table, out)` on every set, and compares each with the bits of the first and with excess(k, out[k]) <= 0:
/// its error minus the bound, both in ULP or both absolute.
template <class Run, class Excess>
void expect_stated(const std::string& name, std::size_t size, Run&& run, Excess&& excess) {
    Floats first;
    for (const Set& set : sets()) {
        Floats out(size);
        run(set.math, out.data());
        double worst = -INFINITY;
        for (std::size_t k = 0; k < size; ++k) worst = std::max(worst, excess(k, out[k]));
        EXPECT_LE(worst, 0) << name << " on " << set.isa;
        if (first.empty()) first = out;
        expect_same_bits(out, first, name + " on " + set.isa);
    }
}

TEST(MathConformance, SineAndCosineOfTurns) {
    const Floats x = unit_numbers(1);
    const auto angle = [&](std::size_t k) {
        return 2 * 3.14159265358979323846264338327950288L * static_cast<long double>(x[k]);
    };
    const auto off = [](float got, long double want) {
        return static_cast<double>(std::fabs(static_cast<long double>(got) - want)) - 1.2e-7;
    };
    expect_stated(
        "sin", n, [&](const MathTable& t, float* out) { t.sin(x.data(), out, n); },
        [&](std::size_t k, float v) { return off(v, sinl(angle(k))); });
    expect_stated(
        "cos", n, [&](const MathTable& t, float* out) { t.cos(x.data(), out, n); },
        [&](std::size_t k, float v) { return off(v, cosl(angle(k))); });
}

TEST(MathConformance, PowersOfTwo) {
    Floats x(n);
    for (std::size_t k = 0; k < n; ++k) x[k] = -126 + 253 * draw(2, 0, k).x;
    expect_stated(
        "exp2", n, [&](const MathTable& t, float* out) { t.exp2(x.data(), out, n); },
        [&](std::size_t k, float v) { return ulps(v, exp2l(static_cast<long double>(x[k]))) - 1.5; });
}

/// Exponents from 1e-6 to 1e6, equally many per decade.
Floats exponents(float least, float most) {
    Floats y(n);
    for (std::size_t k = 0; k < n; ++k) y[k] = least * std::pow(most / least, draw(3, 1, k).y);
    return y;
}

TEST(MathConformance, PowerAndWhatItLacksOfOne) {
    const Floats x = unit_numbers(4), y = exponents(1e-6f, 131072);
    const auto want = [&](std::size_t k) {
        return powl(static_cast<long double>(x[k]), static_cast<long double>(y[k]));
    };
    expect_stated(
        "pow", n, [&](const MathTable& t, float* out) { t.pow(x.data(), y.data(), out, n); },
        [&](std::size_t k, float v) {
            const long double w = want(k);
            return w > 0x1p-24L ? ulps(v, w) - 3 : w > 0x1p-125L ? ulps(v, w) - 12 : static_cast<double>(v) - 0x1p-124;
        });
    expect_stated(
        "1 - pow", n, [&](const MathTable& t, float* out) { t.pow_one_minus(x.data(), y.data(), out, n); },
        [&](std::size_t k, float v) {
            return ulps(v, -expm1l(static_cast<long double>(y[k]) * logl(static_cast<long double>(x[k])))) - 5;
        });
}

TEST(MathConformance, RootAndWhatItLacksOfOne) {
    const Floats x = unit_numbers(5), y = exponents(1e-6f, 0.5f);
    expect_stated(
        "root", n, [&](const MathTable& t, float* out) { t.root(x.data(), y.data(), out, n); },
        [&](std::size_t k, float v) {
            return ulps(v, powl(static_cast<long double>(x[k]), static_cast<long double>(y[k]))) -
                (2 + static_cast<double>(y[k]) * std::fabs(std::log2(static_cast<double>(x[k]))));
        });
    expect_stated(
        "1 - root", n, [&](const MathTable& t, float* out) { t.root_one_minus(x.data(), y.data(), out, n); },
        [&](std::size_t k, float v) {
            return ulps(v, -expm1l(static_cast<long double>(y[k]) * logl(static_cast<long double>(x[k])))) - 5;
        });
}

TEST(MathConformance, LogarithmOfOneMinus) {
    const Floats u = unit_numbers(6);
    expect_stated(
        "log_one_minus", n, [&](const MathTable& t, float* out) { t.log_one_minus(u.data(), out, n); },
        [&](std::size_t k, float v) { return ulps(v, log1pl(-static_cast<long double>(u[k]))) - 3; });
}

/// n unit vectors about z, separated by up to 1/scale, three arrays one after another.
Floats directions(std::uint32_t seed, const Floats& scale) {
    Floats a(3 * n);
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2<float> u = draw(seed, 2, k);
        const double r = std::min(static_cast<double>(u.x) / static_cast<double>(scale[k]), 0.999),
                     phi = 2 * pi * static_cast<double>(u.y);
        a[k] = static_cast<float>(r * std::cos(phi));
        a[n + k] = static_cast<float>(r * std::sin(phi));
        a[2 * n + k] = static_cast<float>(std::sqrt(1 - r * r));
    }
    return a;
}

TEST(MathConformance, CosinePower) {
    const Floats s = exponents(1, 1e6f);
    Floats width(n);
    for (std::size_t k = 0; k < n; ++k) width[k] = std::sqrt(s[k]) / 3;
    const Floats a = directions(6, width), b = directions(7, width);
    expect_stated(
        "cosine_power", n,
        [&](const MathTable& t, float* out) { t.cosine_power(a.data(), b.data(), s.data(), out, n); },
        [&](std::size_t k, float v) {
            long double d2 = 0;
            for (std::size_t c = 0; c < 3; ++c)
                d2 += sqr(static_cast<long double>(a[c * n + k]) - static_cast<long double>(b[c * n + k]));
            const long double power = static_cast<long double>(s[k]), cos = 1 - d2 / 2;
            if (cos <= 0) return static_cast<double>(v);
            const long double want = expl(power * log1pl(-d2 / 2));
            if (want < 0x1p-100L) return static_cast<double>(v) - 0x1p-99;
            return ulps(v, want) - static_cast<double>(3 + 4 * power * (1 - cos) / cos);
        });
}

TEST(MathConformance, Normalize) {
    Floats a(3 * n);
    for (std::size_t k = 0; k < 3 * n; ++k) {
        const Vec2<float> u = draw(8, 3, k);
        a[k] = (2 * u.x - 1) * std::exp2(60 * u.y - 30);
    }
    const auto norm = [&](std::size_t k) {
        long double sum = 0;
        for (std::size_t c = 0; c < 3; ++c) sum += sqr(static_cast<long double>(a[c * n + k % n]));
        return sqrtl(sum);
    };
    expect_stated(
        "normalize", 3 * n, [&](const MathTable& t, float* out) { t.normalize(a.data(), out, n); },
        [&](std::size_t k, float v) { return ulps(v, static_cast<long double>(a[k]) / norm(k)) - 3; });
}

}  // namespace math_isa_test
}  // namespace crescent::test
