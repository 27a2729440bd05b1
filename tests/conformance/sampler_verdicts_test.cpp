// Built-in samplers have the verdicts predicted by theory, also at the limits of their parameters; inconclusive
// verdicts name a next step. tests/system/check.sh checks every sampler at its usual parameters.
#include <cmath>
#include <gtest/gtest.h>
#include <set>

#include "base/errors.h"
#include "check/report/print.h"
#include "check/sources/cases.h"
#include "check/sources/external.h"
#include "check/sources/pipe.h"
#include "tests/support/checked.h"
#include "tests/support/sanitized.h"

namespace crescent {
namespace sampler_verdicts_test {

CheckResult check_quickly(
    const std::vector<CheckCase>& check_cases, const TestSettings& settings = TestSettings::quick()) {
    ProgressMonitor monitor;
    return run_checks(check_cases, settings, monitor);
}

const Verdict& find(const CheckResult& j, const std::string& check_case, const std::string& name) {
    for (const Verdict& v : j.verdicts)
        if (v.check_case.find(check_case) != std::string::npos && v.name == name) return v;
    throw std::runtime_error("no verdict " + name + " on " + check_case);
}

/// Phong's lobe does not reach the horizon, where part of Lambert's light is.
TEST(Arms, PhongOnLambertLosesSupport) {
    const CheckResult j = check_quickly(make_cases("phong", {{"s", 32}}, false, {{60, 250}}));
    EXPECT_EQ(find(j, "w_o 60 deg az 250, s=32, Lambert + Phong", "support").state, State::wrong);
    EXPECT_EQ(find(j, "w_o 60 deg az 250, s=32, Phong", "support").state, State::right);
}

bool reads(const std::string& arm, const Settings& settings) {
    try {
        return !make_cases(arm, settings, false).empty();
    } catch (const InputError&) { return false; }
}

class ArmsAtTheLimits : public testing::TestWithParam<int> {};

TEST_P(ArmsAtTheLimits, OfTheSchemaHaveTheVerdictsOfTheory) {
    const Settings at[] = {{{"s", 1e-3}}, {{"s", 1e6}}, {{"alpha", 1e-4}}, {{"alpha", 1}}};
    const std::vector<std::string> arms = sampler_names();
    for (std::size_t k = 0; k < arms.size(); k += test::every) {
        const Settings& settings = at[GetParam()];
        if (!reads(arms[k], settings)) continue;
        const CheckResult j = check_quickly(make_cases(arms[k], settings, false, {{45, 130}}));
        EXPECT_TRUE(j.as_expected) << arms[k] << " " << settings.begin()->first << "=" << settings.begin()->second
                                   << "\n"
                                   << verdict_table(j);
        for (const Verdict& v : j.verdicts)
            if (v.state == State::inconclusive)
                EXPECT_FALSE(v.message().empty() || next_step_text(v).empty())
                    << v.arm << " [" << v.check_case << "] " << v.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Settings, ArmsAtTheLimits, testing::Range(0, 4));

TEST(Programs, TooSlowOnesAreInconclusive) {
    PipeLimits limits;
    limits.total_seconds = 0.5;
    const std::string slow =
        "read hello; echo hello 2 slow; read f; echo -; while read verb; do sleep 0.2; echo 0 0 1 1; done";
    const CheckResult j = check_quickly(make_user_cases(start_pipe(slow, limits), false));
    EXPECT_EQ(j.state, State::inconclusive);
    EXPECT_EQ(j.left_out.size(), 8u);
    for (const Verdict& v : j.verdicts) {
        EXPECT_EQ(v.state, State::inconclusive) << v.name << v.message();
        EXPECT_FALSE(next_step_text(v).empty()) << v.name;
    }
}

TEST(LightsOfACase, AreSeenByTheNearest) {
    const CaseLighting light = case_setup(LobeKind::none, true, "fill + two disks", 32).light;
    ASSERT_EQ(light.disks.size(), 2u);
    int both = 0, front = 0, back = 0;
    for (double theta = 0; theta < 90; ++theta)
        for (double azimuth = 0; azimuth < 90; ++azimuth) {
            const Vec3d wi = tilt(theta, azimuth);
            const auto far = light.disks[0].distance(wi), near = light.disks[1].distance(wi);
            both += far && near;
            front += near && !far;
            back += far && !near;
            EXPECT_EQ(light(wi),
                near           ? light.disks[1].radiance
                    : far      ? light.disks[0].radiance
                    : wi.z > 0 ? 1
                               : 0)
                << theta << " " << azimuth;
        }
    EXPECT_GT(both, 50);
    EXPECT_GT(front, 50);
    EXPECT_GT(back, 50);
}

TEST(LightsOfACase, BallHidesTheRectangleBehindIt) {
    int hidden = 0;
    const CaseLighting light = case_setup(LobeKind::none, true, "sphere + rectangle", 32).light;
    for (double theta = 0; theta < 90; ++theta)
        for (double azimuth = 90; azimuth < 180; ++azimuth) {
            const Vec3d wi = tilt(theta, azimuth);
            const bool both = light.area_lights[0].distance(wi) && light.area_lights[1].distance(wi);
            hidden += both;
            if (both) EXPECT_EQ(light(wi), light.area_lights[0].radiance);
        }
    EXPECT_GT(hidden, 50);
}

}  // namespace sampler_verdicts_test
}  // namespace crescent
