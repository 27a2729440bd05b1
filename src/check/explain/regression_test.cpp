// Synthetic counts with known exponents.
#include "check/explain/regression.h"

#include <gtest/gtest.h>

#include "check/estimate/stream.h"
#include "math/functions.h"

namespace crescent::check {
namespace regression_test {

/// 2 groups of 500 cells and two factors; a normal distribution replaces the Poisson distribution at these counts.
std::vector<Row> counts(double b0, double b1, double c0, double c1) {
    Stream stream({5, 0, 0, 1, Purpose::pairs});
    std::vector<Row> rows;
    for (std::size_t i = 0; i < 1000; ++i) {
        Row r;
        r.group = i % 2;
        r.expected = 50 + 400 * stream.number();
        r.x = {math::log(0.05 + stream.number()), math::log(0.05 + stream.number()), math::log(0.05 + stream.number())};
        const double mu = r.expected * (r.group ? c1 : c0) * math::exp(b0 * r.x[0] + b1 * r.x[1]);
        double z = -6;
        for (int k = 0; k < 12; ++k) z += stream.number();
        r.observed = std::max(0.0, mu + z * std::sqrt(mu));
        rows.push_back(r);
    }
    return rows;
}

TEST(CheckRegression, FitsExponentsAndConstantsWithinTheirErrors) {
    const std::vector<Row> rows = counts(1, -0.5, 2, 0.7);
    const Fit f = fit(rows, 2, {0, 1});
    EXPECT_NEAR(f.exponents[0], 1, 4 * f.errors[0]);
    EXPECT_NEAR(f.exponents[1], -0.5, 4 * f.errors[1]);
    EXPECT_LT(f.errors[0], 0.02);
    EXPECT_NEAR(f.constants[0], 2, 0.02);
    EXPECT_NEAR(f.constants[1], 0.7, 0.02);
    EXPECT_NEAR(f.misfit, 1, 0.2);
    EXPECT_GT(fit(rows, 2, {}).misfit, 10);  // constants alone do not explain it
}

TEST(CheckRegression, SelectsTheFactorsThatMatterAndNoOthers) {
    EXPECT_TRUE(select(counts(0, 0, 1, 1), 2, 3, 3).factors.empty());
    EXPECT_EQ(select(counts(0, 1, 1, 1), 2, 3, 3).factors, std::vector<std::size_t>{1});
    EXPECT_EQ(select(counts(1, -1, 1, 1), 2, 3, 3).factors.size(), 2u);
}

}  // namespace regression_test
}  // namespace crescent::check
