// Known variances, and ranks by them.
#include "check/decide/efficiency.h"

#include <gtest/gtest.h>

#include "check/decide/check_sampler.h"
#include "check/sources/cases.h"

namespace crescent::check {
namespace efficiency_test {

/// Lambert of albedo 0.5 under a uniform light: X of a uniform draw is cos, of variance 1 / 12; X of a cosine draw is
/// always 0.5.
TEST(EfficiencyOfSamplers, HasTheVarianceOfTheWeights) {
    std::vector<CheckCase> check_cases;
    const CaseSetup setup = case_setup(LobeKind::none, true, "fill", 32);
    for (const char* arm : {"uniform", "cosine"}) {
        check_cases.push_back(make_case_on(setup, 30, 0, arm, nullptr));
        check_cases.back().adapter = sampler_on(arm, check_cases.back());
    }
    CheckCase baseline = check_cases[0];
    baseline.baseline = true;
    check_cases.push_back(baseline);
    CheckSettings settings;
    settings.budget = CheckBudget::limited();
    ProgressMonitor monitor;
    const std::vector<CheckOutcome> outcomes = check_samplers(check_cases, settings, monitor);
    std::vector<Efficiency> all = variances_of(check_cases, outcomes, settings, monitor);
    ASSERT_EQ(all.size(), 3u);
    EXPECT_NEAR(all[0].variance, 1.0 / 12, 4 * all[0].relative_se / 12);
    EXPECT_NEAR(all[2].variance, 1.0 / 12, 4 * all[2].relative_se / 12);
    EXPECT_LT(all[1].variance, 1e-9);
    for (Efficiency& e : all) {
        e.nanoseconds = 10;
        e.cost_se = 0.01;
    }  // equal times: the variance decides the rank
    const std::vector<Verdict> v = test_efficiency(check_cases, all);
    EXPECT_EQ(v[0].state, State::right);
    EXPECT_NE(v[0].timed_message.find("higher than that of cosine"), std::string::npos) << v[0].timed_message;
    EXPECT_NE(v[1].timed_message.find("lower than that of uniform"), std::string::npos) << v[1].timed_message;
    EXPECT_EQ(v[0].message().find("ns"), std::string::npos);  // values that vary between runs are stored separately
}

TEST(EfficiencyOfSamplers, MeasuresTheTimeOfASample) {
    std::vector<CheckCase> check_cases = {
        make_case_on(case_setup(LobeKind::none, true, "fill", 32), 30, 0, "cosine", nullptr)};
    check_cases[0].adapter = sampler_on("cosine", check_cases[0]);
    std::vector<Efficiency> all(1);
    all[0].has_weights = true;
    measure_costs(check_cases, 1, all, ProgressMonitor{});
    EXPECT_GT(all[0].nanoseconds, 0);
    EXPECT_LT(all[0].nanoseconds, 1e5);
}

}  // namespace efficiency_test
}  // namespace crescent::check
