// Estimators with known means and tails, and expressions of constants.
#include "check/numbers/number_check.h"

#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>

#include "check/numbers/expression.h"

namespace crescent::check {

namespace {
namespace number_check_test {

class Values : public SamplerSource {
public:
    explicit Values(double (*value)(double)) : value_(value) {}
    std::string name() const override { return "values"; }
    Traits traits() const override {
        Traits t;
        t.numbers = 1;
        t.number = true;
        t.has_pdf = false;
        t.wo = Traits::WoDomain::none;
        return t;
    }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) out[i] = {{0, 0, 1}, 1, value_(u[i][0])};
    }
    void pdf(int, std::span<const Pair>, std::span<double> out) const override { std::ranges::fill(out, 1.0); }

private:
    double (*value_)(double);
};

CheckResult checked(double (*value)(double), double expected, std::uint32_t seed = 1) {
    TestSettings settings;
    settings.seed = seed;
    ProgressMonitor monitor;
    return check_number(
        std::make_shared<Values>(value), {.value = std::array{expected, expected, expected}}, settings, monitor);
}
State state_of(const CheckResult& result, std::string_view name) {
    return std::ranges::find(result.verdicts, name, &Verdict::name)->state;
}

double ramp(double u) { return 2 * u; }
double roulette(double u) { return u < 0.05 ? 20 : 0; }
double heavy(double u) { return 0.3 * std::pow(u, -0.7); }

TEST(NumberCheck, AcceptsRightMeans) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        EXPECT_EQ(checked(ramp, 1, seed).state, State::right) << seed;
        EXPECT_EQ(checked(roulette, 1, seed).state, State::right) << seed;
    }
}

TEST(NumberCheck, FindsTheStatedBias) {
    int found = 0;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        const CheckResult right = checked(ramp, 1, seed);
        const auto mean = std::ranges::find(right.verdicts, "mean", &Verdict::name);
        const double hidden = mean->hidden.at("bias");
        EXPECT_LE(hidden, 0.01);
        found += checked(ramp, 1 + hidden, seed + 1000).state == State::wrong;
    }
    EXPECT_GE(found, 15);
}

/// Of an estimator of 0, sizes are relative to the spread of its values, which is 1 / sqrt(12) here.
TEST(NumberCheck, OfZeroIsRelativeToTheSpread) {
    const auto centred = [](double u) { return u - 0.5; };
    const auto shifted = [](double u) { return u - 0.45; };
    const CheckResult right = checked(centred, 0), wrong = checked(shifted, 0);
    EXPECT_EQ(right.state, State::right);
    EXPECT_LE(std::ranges::find(right.verdicts, "mean", &Verdict::name)->hidden.at("bias"), 0.01);
    const auto mean = std::ranges::find(wrong.verdicts, "mean", &Verdict::name);
    EXPECT_EQ(mean->state, State::wrong);
    EXPECT_NEAR(mean->size, 0.05 * std::sqrt(12), 0.01);
    EXPECT_NE(mean->message().find("of the standard deviation of a value"), std::string::npos) << mean->message();
}

TEST(NumberCheck, StatesTheRoundingOfAConstant) {
    const CheckResult result = checked([](double) { return 3.0; }, 3.00001);
    EXPECT_GT(std::ranges::find(result.verdicts, "mean", &Verdict::name)->hidden.at("bias"), 3.3e-6);
}

TEST(NumberCheck, GivesNoMeanForAHeavyTail) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        const CheckResult result = checked(heavy, 1, seed);
        EXPECT_EQ(state_of(result, "tail"), State::inconclusive);
        EXPECT_EQ(state_of(result, "mean"), State::inconclusive);
    }
}

TEST(NumberCheck, ReportsValuesThatAreNotFinite) {
    const CheckResult result = checked([](double u) { return u < 0.1 ? std::nan("") : 1.0; }, 1);
    EXPECT_EQ(state_of(result, "valid"), State::wrong);
    EXPECT_EQ(state_of(result, "mean"), State::skipped);
}

TEST(NumberCheck, ComparesTwoEstimators) {
    TestSettings settings;
    ProgressMonitor monitor;
    const auto against = [&](double (*value)(double)) {
        return check_number(
            std::make_shared<Values>(ramp), {.estimator = std::make_shared<Values>(value)}, settings, monitor);
    };
    EXPECT_EQ(against(roulette).state, State::right);
    EXPECT_EQ(against([](double u) { return 3.1 * u * u; }).state, State::wrong);
}

TEST(Expression, IsEvaluated) {
    EXPECT_DOUBLE_EQ(constant_value("0.8187"), 0.8187);
    EXPECT_DOUBLE_EQ(constant_value("exp(-1.7)"), math::exp(-1.7));
    EXPECT_DOUBLE_EQ(constant_value("2 * pi / 3 - -1"), 2 * 3.14159265358979323846 / 3 + 1);
    EXPECT_DOUBLE_EQ(constant_value("-2^2 + 1e-3"), -4 + 1e-3);
    EXPECT_DOUBLE_EQ(constant_value("2^3^2"), 512);
    for (const char* wrong : {"", "1 +", "exp", "exp 1", "(1", "1)", "x", "1/0", "log(-1)", "1 2"})
        EXPECT_THROW(constant_value(wrong), std::invalid_argument) << wrong;
    EXPECT_THROW(constant_value(std::string(100000, '(')), std::invalid_argument);
    EXPECT_THROW(constant_value(std::string(100000, '-')), std::invalid_argument);
}

}  // namespace number_check_test
}  // namespace

}  // namespace crescent::check
