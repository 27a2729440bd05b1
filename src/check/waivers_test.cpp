// Expectations of the caller: a waived verdict does not count, an unmatched expectation does, and an unknown word is
// reported with its place and the nearest known one.
#include "check/waivers.h"

#include <fstream>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "check/report/print.h"
#include "check/report/result_json.h"
#include "check/verdict.h"
#include "output/junit.h"

namespace crescent {
namespace waivers_test {

CheckResult of(std::initializer_list<std::tuple<const char*, const char*, State>> verdicts) {
    CheckResult j;
    for (const auto& [arm, name, state] : verdicts) {
        Verdict v;
        v.arm = arm;
        v.check_case = "w_o 45 deg";
        v.name = name;
        v.state = state;
        v.sentences = {{"finding", "So it is."}};
        v.expected = state == State::right;
        j.verdicts.push_back(v);
    }
    return j;
}

State waived(CheckResult& j, std::vector<std::string> texts) {
    waive(j, read_waivers(texts));
    return j.state;
}

std::string fault_of(const std::string& text) {
    try {
        read_waivers(std::vector<std::string>{text});
    } catch (const InputError& e) { return e.what(); }
    return "";
}

TEST(Waivers, ExpectedFailureDoesNotChangeTheState) {
    CheckResult j = of({{"phong", "support", State::wrong}, {"phong", "valid", State::right}});
    EXPECT_EQ(waived(j, {}), State::wrong);
    EXPECT_EQ(waived(j, {"phong support=wrong: it never reaches the horizon"}), State::right);
    EXPECT_TRUE(j.as_expected);
    EXPECT_EQ(j.verdicts[0].why_expected, "it never reaches the horizon");
    EXPECT_EQ(j.verdicts[0].state, State::wrong) << "the verdict itself stays";
    EXPECT_NE(verdict_table(j).find("phong: wrong support as waived"), std::string::npos) << verdict_table(j);
}

TEST(Waivers, ApplyOnlyToTheNamedArmAndVerdict) {
    const auto state = [](const char* text) {
        CheckResult j = of({{"my glass", "tail", State::inconclusive}, {"other", "tail", State::inconclusive}});
        return waived(j, {text});
    };
    EXPECT_EQ(state("my glass tail=inconclusive: GGX by its normals"), State::inconclusive);
    EXPECT_EQ(state("tail=inconclusive: heavy"), State::right);
    EXPECT_EQ(state("* tail = inconclusive: heavy"), State::right);
    EXPECT_EQ(state("tail=wrong: heavy"), State::wrong) << "none is wrong, which was expected";
}

TEST(Waivers, ThatNothingMeetsAnyMoreFail) {
    CheckResult j = of({{"phong", "support", State::right}});
    EXPECT_EQ(waived(j, {"phong support=wrong: it never reaches the horizon"}), State::wrong);
    ASSERT_EQ(j.unmet.size(), 1u);
    EXPECT_NE(j.unmet[0].find("phong support is expected to be wrong but is not"), std::string::npos);
    EXPECT_NE(junit_text(verdict_report(j)).find("the expectation can go"), std::string::npos);
    EXPECT_NE(verdict_json(j, {}).find("unmet_expectations"), std::string::npos);
}

TEST(Waivers, AreReadFromAFileWithItsLines) {
    const std::string path = testing::TempDir() + "/waivers.txt";
    std::ofstream(path) << "# what we know\n\nphong support=wrong: the horizon  # for now\n";
    const std::vector<Waiver> w = read_waivers(std::vector<std::string>{path});
    ASSERT_EQ(w.size(), 1u);
    EXPECT_EQ(w[0].arm, "phong");
    EXPECT_EQ(w[0].reason, "the horizon");
    EXPECT_EQ(w[0].place, path + ":3");
    std::ofstream(path) << "phong suport=wrong\n";
    EXPECT_NE(fault_of(path).find(path + ":1"), std::string::npos) << fault_of(path);
}

TEST(Waivers, SayWhatIsKnownWhereAWordIsNot) {
    for (const char* text : {"support=wrong", "support=wrong:", "phong support = wrong : "})
        EXPECT_NE(fault_of(text).find("expected the reason"), std::string::npos) << text << ": " << fault_of(text);
    EXPECT_NE(fault_of("phong suport=wrong").find("did you mean 'support'?"), std::string::npos);
    EXPECT_NE(fault_of("support=right").find("expected wrong or inconclusive, got 'right'"), std::string::npos);
    EXPECT_NE(fault_of("/no/such/file").find("nor a file that can be read"), std::string::npos);
    const std::vector<Waiver> w = read_waivers(std::vector<std::string>{"phon support=wrong: the horizon"});
    try {
        check_waivers(w, std::vector<std::string>{"phong", "cosine"});
        ADD_FAILURE() << "phon is no arm";
    } catch (const InputError& e) { EXPECT_NE(std::string(e.what()).find("did you mean 'phong'?"), std::string::npos); }
}

}  // namespace waivers_test
}  // namespace crescent
