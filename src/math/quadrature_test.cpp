// n points are exact for polynomials up to degree 2n - 1, here on [-1, 2], and not beyond.
#include <gtest/gtest.h>

#include "math/quadrature.h"

namespace crescent::math {
namespace quadrature_test {

template <unsigned n> void is_exact() {
    for (unsigned degree = 0; degree < 2 * n; ++degree) {
        const double exact = (pow(2, degree + 1) - pow(-1, degree + 1)) / (degree + 1);
        const double ours = Gauss<n>::integrate([&](double x) { return pow(x, degree); }, -1, 2);
        EXPECT_NEAR(ours / exact, 1, 1e-13) << n << " points, x^" << degree;
    }
}

TEST(Gauss, IsExactForPolynomialsOfTwiceItsPoints) {
    is_exact<1>();
    is_exact<2>();
    is_exact<3>();
    is_exact<7>();
    is_exact<30>();
    is_exact<60>();
    EXPECT_GT(std::fabs(Gauss<2>::integrate([](double x) { return x * x * x * x; }, -1, 1) - 0.4), 1e-3);
}

}  // namespace quadrature_test
}  // namespace crescent::math
