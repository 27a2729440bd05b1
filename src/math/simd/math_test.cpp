// Floats against the C library in double or long double, over every argument or a fine subset; the bounds are those
// that math.h states.
#include "math/simd/math.h"

#include <gtest/gtest.h>

#include <cmath>

namespace crescent {
namespace math_test {

double ulps(float got, long double want) {
    const float near = static_cast<float>(want);
    const float ulp = std::nextafter(std::fabs(near), INFINITY) - std::fabs(near);
    return static_cast<double>(std::fabs(got - want) / ulp);
}

TEST(ElementaryFunctions, SincosTurnsKeepsItsStatedError) {
    double worst = 0;
    for (std::uint32_t k = 0; k <= (1u << 24); k += 7) {
        const float u = static_cast<float>(k) * 0x1p-24f;
        const SinCos<float> sc = sincos_turns(u);
        const double a = 2 * pi * static_cast<double>(u);
        worst = std::max({worst, std::fabs(sc.sin - std::sin(a)), std::fabs(sc.cos - std::cos(a))});
    }
    EXPECT_LE(worst, 1.2e-7);
    RecordProperty("worst", std::to_string(worst));
}

TEST(ElementaryFunctions, Exp2KeepsItsStatedError) {
    double worst = 0;
    for (float x = -126; x <= 127; x += 0.000731f)
        worst = std::max(worst, ulps(exp2(x), exp2l(static_cast<long double>(x))));
    EXPECT_LE(worst, 1.5);
    EXPECT_EQ(exp2(-127.0f), 0.0f);
}

TEST(ElementaryFunctions, PowErrorIsWithinBoundForUsedExponents) {
    double near_one = 0, far = 0;
    for (float y :
        {1.0f / 100001, 1.0f / 129, 1.0f / 33, 1.0f / 9, 0.5f, 1.0f, 1.5f, 8.0f, 32.0f, 33.7f, 128.0f, 1000.5f, 1e5f}) {
        for (std::uint32_t k = 1; k < (1u << 24); k += 101) {
            const float x = static_cast<float>(k) * 0x1p-24f;
            const long double want = powl(static_cast<long double>(x), static_cast<long double>(y));
            if (want < 0x1p-125L) continue;
            (want > 0x1p-24L ? near_one : far) = std::max(want > 0x1p-24L ? near_one : far, ulps(pow(x, y), want));
        }
    }
    EXPECT_LE(near_one, 3.0);
    EXPECT_LE(far, 12.0);
}

TEST(ElementaryFunctions, PowClampsAtZeroAndKeepsTheEnds) {
    EXPECT_EQ(pow(0.0f, 32.0f), 0.0f);
    EXPECT_EQ(pow(-0.5f, 32.0f), 0.0f);
    EXPECT_EQ(pow(1.0f, 32.0f), 1.0f);
    EXPECT_EQ(pow(1.0f, 1.0f / 33), 1.0f);
    EXPECT_EQ(pow(0.1f, 128.0f), 0.0f);
}

}  // namespace math_test
}  // namespace crescent
