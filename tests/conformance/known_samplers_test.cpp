// Every sampler with a known verdict, in quick mode: planted faults and those of the lists are found, most under the
// expected verdict, and correct ones pass. tests/calibration measures many more.
#include <gtest/gtest.h>

#include "check/report/summary.h"
#include "tests/known_samplers/study/false_alarms.h"
#include "tests/known_samplers/faulty/planted.h"
#include "tests/known_samplers/reported/known.h"
#include "tests/support/checked.h"
#include "tests/support/sanitized.h"

namespace crescent {
namespace known_samplers_test {

/// Each list is checked in this many parts, of a few seconds each.
constexpr std::size_t parts = 8;
class InParts : public testing::TestWithParam<std::size_t> {};
class KnownSamplers : public InParts {};
class PlantedFaults : public InParts {};
class HeldOutFaults : public InParts {};
class RightSamplers : public InParts {};

bool is_wrong(const CheckResult& j, std::string_view name) {
    return std::ranges::any_of(
        j.verdicts, [&](const Verdict& v) { return v.state == State::wrong && (name.empty() || v.name == name); });
}

/// At one of the w_o of each, in turn; ./test --matrix tests all.
TEST_P(KnownSamplers, HaveTheVerdictThatIsKnown) {
    const std::vector<KnownSampler> all = known_samplers();
    for (std::size_t k = GetParam(); k < all.size(); k += parts * test::every)
        for (std::size_t w = 0; w < all[k].check_cases.size(); ++w) {
            if (!test::whole_matrix() && w != k / parts % all[k].check_cases.size()) continue;
            const CheckCase& t = all[k].check_cases[w];
            const CheckResult j = checked_alone(t, TestSettings::quick());
            const std::string message = all[k].name + " at " + t.text() + "\n" + what_is_wrong(j);
            if (all[k].known == Known::wrong || all[k].known == Known::called_wrong)
                EXPECT_TRUE(is_wrong(j, all[k].verdict)) << message;
            else if (all[k].known == Known::right) EXPECT_EQ(j.state, State::right) << message;
            else EXPECT_FALSE(is_wrong(j, "")) << message;
        }
}

/// At two of the w_o of each; ./test --matrix tests all.
void expect_found(const std::vector<PlantedFault>& faults, std::size_t part) {
    ProgressMonitor monitor;
    for (std::size_t k = part; k < faults.size(); k += parts * test::every) {
        std::vector<CheckCase> check_cases = faults[k].check_cases;
        if (check_cases.size() == 3 && !test::whole_matrix())
            check_cases.erase(check_cases.begin() + 2 * static_cast<int>(k % 2));
        const CheckResult j = run_checks(check_cases, TestSettings::quick(), monitor);
        EXPECT_TRUE(is_wrong(j, faults[k].verdict)) << faults[k].name << "\n" << what_is_wrong(j);
    }
}

TEST_P(PlantedFaults, AreFoundUnderTheirVerdict) { expect_found(planted_faults(false), GetParam()); }

TEST_P(HeldOutFaults, AreFound) {
    expect_found(held_out_faults(), GetParam());
    expect_found(held_out_lobe_faults(), GetParam());
}

TEST_P(RightSamplers, OfEveryFamilyAreNotWrong) {
    ProgressMonitor monitor;
    const std::size_t each = (test::whole_matrix() ? 64 : 24) / parts;
    const FalseAlarmStudy study = measure_false_alarms(GetParam() * each, each, TestSettings::quick(), monitor);
    std::string message;
    for (const std::string& line : study.message) message += line;
    EXPECT_EQ(study.false_alarms, 0u) << message;
}

INSTANTIATE_TEST_SUITE_P(Parts, KnownSamplers, testing::Range(std::size_t{0}, parts));
INSTANTIATE_TEST_SUITE_P(Parts, PlantedFaults, testing::Range(std::size_t{0}, parts));
INSTANTIATE_TEST_SUITE_P(Parts, HeldOutFaults, testing::Range(std::size_t{0}, parts));
INSTANTIATE_TEST_SUITE_P(Parts, RightSamplers, testing::Range(std::size_t{0}, parts));

TEST(KnownLists, AreMany) {
    EXPECT_GE(known_samplers().size(), 100u);
    EXPECT_GE(planted_faults(false).size(), 85u);
    EXPECT_GE(held_out_faults().size() + held_out_lobe_faults().size(), 40u);
}

}  // namespace known_samplers_test
}  // namespace crescent
