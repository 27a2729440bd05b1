// The random numbers of samplers under test are those of the estimator.
#include "check/sources/random_numbers.h"

#include <cmath>
#include <gtest/gtest.h>

#include "math/simd/random.h"

namespace crescent {
namespace random_numbers_test {

TEST(DrawnNumbers, AreThoseOfTheEstimator) {
    const PrimarySample u = drawn_numbers(7, 3, 11, 0, 2);
    EXPECT_EQ(u.x, static_cast<double>(draw(7, 3, 11).x));
    EXPECT_EQ(u.y, static_cast<double>(draw(7, 3, 11).y));
    const PrimarySample eight = drawn_numbers(7, 3, 11, 0, 8);
    EXPECT_EQ(eight.x, u.x);
    for (int a = 0; a < 8; ++a)
        for (int b = 0; b < a; ++b) EXPECT_NE(eight[a], eight[b]);
    EXPECT_NE(drawn_numbers(7, 3, 11, 1, 2).x, u.x);  // of another technique
    for (int k = 0; k < 8; ++k) EXPECT_EQ(std::fmod(eight[k] * 0x1p24, 1), 0);
}

}  // namespace random_numbers_test
}  // namespace crescent
