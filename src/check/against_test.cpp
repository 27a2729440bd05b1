// Two samplers with known densities compared: distribution, f, and the ratio of their variances in closed form.
#include "check/against.h"

#include <gtest/gtest.h>

#include "check/check.h"
#include "tests/support/checked.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace against_test {

/// Draws by a power of the cosine, of a Lambert surface.
std::shared_ptr<const SamplerAdapter> power(double s, double albedo = 0.5) {
    FunctionSampler out = power_sampler(s);
    out.f_value = lambert(albedo);
    return std::make_shared<FunctionSampler>(out);
}
FunctionSampler uniform() {
    FunctionSampler out;
    out.draw = [](Vec3d, const PrimarySample& u) { return from_chart({u.x, two_pi * u.y}); };
    out.p = [](Vec3d, Vec3d w) { return w.z > 0 ? 1 / two_pi : 0; };
    return out;
}

CheckResult compared(const std::shared_ptr<const SamplerAdapter>& a, const std::shared_ptr<const SamplerAdapter>& b,
    bool expect_same = false) {
    const CheckCase of_a = make_user_case(a, 40, 10), of_b = make_user_case(b, 40, 10);
    TestSettings settings;
    settings.budget = CheckBudget::limited(2e5);
    ProgressMonitor monitor;
    return compare_samplers({&of_a, 1}, {&of_b, 1}, settings, expect_same, monitor);
}

// X = f cos / p. Uniform: z, of variance 1/3 - 1/4. Power 1/2: 2/3 z^(1/2), of variance 4/15 - 1/4.
TEST(TwoSamplers, HaveTheRatioOfTheirVariances) {
    FunctionSampler even = uniform();
    even.f_value = lambert(0.5);
    const CheckResult r = compared(std::make_shared<FunctionSampler>(even), power(0.5));
    const Verdict& v = named(r, "variance");
    const double ratio = (1 / 3.0 - 1 / 4.0) / (4 / 15.0 - 1 / 4.0);
    EXPECT_LE(v.evidence["interval"][0].get<double>(), ratio);
    EXPECT_GE(v.evidence["interval"][1].get<double>(), ratio);
    EXPECT_GT(v.evidence["interval"][0].get<double>(), 0.7 * ratio);
    EXPECT_EQ(named(r, "same_f").same, true);
    EXPECT_EQ(named(r, "same_distribution").same, false);
    EXPECT_EQ(named(r, "same_distribution").state, State::right);  // reported, but not wrong
    EXPECT_EQ(r.state, State::right);
}

TEST(TwoSamplers, MayBeExpectedToBeTheSame) {
    const CheckResult same = compared(power(1), power(1), true), other = compared(power(1), power(1.2), true),
                      other_f = compared(power(1), power(1, 0.51), true);
    EXPECT_EQ(same.state, State::right);
    EXPECT_EQ(other.state, State::wrong);
    EXPECT_EQ(named(other, "same_f").state, State::right);
    EXPECT_EQ(named(other_f, "same_f").state, State::wrong);
    EXPECT_EQ(named(other_f, "same_distribution").state, State::right);
}

TEST(TwoSamplers, OfAWrongOneAreNotRanked) {
    FunctionSampler wrong = power_sampler(1);
    wrong.f_value = lambert(0.5);
    wrong.p = [](Vec3d o, Vec3d w) { return 1.1 * cosine_pdf(o, w); };
    const CheckResult r = compared(std::make_shared<FunctionSampler>(wrong), power(1));
    EXPECT_FALSE(named(r, "variance").evidence.contains("interval"));
    EXPECT_NE(named(r, "variance").state, State::right);
}

}  // namespace against_test
}  // namespace crescent::check
