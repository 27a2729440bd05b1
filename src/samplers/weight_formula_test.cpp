// Formulas against the same expressions of C++, and lists of weights whose sum is not one.
#include "samplers/weight_formula.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace crescent {
namespace weight_formula_test {

const double densities[] = {0.5, 2};
const FormulaInputs inputs{
    .s = 32, .alpha = 0.3, .rho_d = 0.2, .rho_s = 0.6, .cos_o = 0.9, .cos_i = 0.7, .p = densities};

double value_of(const char* text) {
    FormulaMistake mistake;
    const WeightFormula formula = WeightFormula::read(text, 2, true, mistake);
    EXPECT_EQ(mistake.message, "") << text;
    return formula(inputs);
}

TEST(WeightFormulas, HaveTheValueOfTheirExpression) {
    EXPECT_DOUBLE_EQ(value_of("1 - rho_s - rho_d"), 1 - 0.6 - 0.2);
    EXPECT_DOUBLE_EQ(value_of("rho_s / rho_d / 2 * 3"), 0.6 / 0.2 / 2 * 3);
    EXPECT_DOUBLE_EQ(value_of("2 ^ 3 ^ 2"), 512);  // from the right
    EXPECT_DOUBLE_EQ(value_of("-2 ^ 2 + s"), 28);
    EXPECT_DOUBLE_EQ(value_of("p1^2 / (p1^2 + p2^2)"), 0.25 / 4.25);
    EXPECT_DOUBLE_EQ(value_of("min(alpha, cos_o) + max(alpha, cos_i)"), 0.3 + 0.7);
    EXPECT_DOUBLE_EQ(value_of("sqrt(4) + exp(0) + log(1)"), 3);
}

/// The weights of two samplers by these formulas; empty if they are refused.
std::vector<double> weights_of(const std::vector<std::string>& texts) {
    std::vector<double> out(2);
    try {
        WeightList(texts, 2, true, {}).evaluate(inputs, out);
    } catch (const InputError&) { return {}; }
    return out;
}

TEST(WeightLists, AreFromZeroToOneAndSumToOne) {
    const auto good = weights_of({"rho_s", "rest"});
    ASSERT_EQ(good.size(), 2u);
    EXPECT_DOUBLE_EQ(good[0], 0.6);
    EXPECT_DOUBLE_EQ(good[1], 0.4);
    EXPECT_EQ(weights_of({"0.3333333333", "0.6666666667"}).size(), 2u);
    for (const char* wrong : {"0.3", "0.5", "1.5", "-0.5", "log(0 - 1)"})
        EXPECT_TRUE(weights_of({"0.6", wrong}).empty()) << wrong;
    EXPECT_TRUE(weights_of({"1.5", "rest"}).empty());
}

}  // namespace weight_formula_test
}  // namespace crescent
