// The first view of one sampler: its order, its limit of rows, and rows that fit a terminal.
#include "check/report/screen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace crescent {
namespace screen_test {

using ::testing::HasSubstr;

/// All verdicts at two w_o, each in the state given by its place in the list, later ones right.
CheckResult in_states(std::initializer_list<State> states) {
    CheckResult out;
    for (const double theta : {30.0, 60.0})
        for (std::size_t i = 0; i < verdict_names.size(); ++i) {
            Verdict& v = out.verdicts.emplace_back();
            v.arm = "made";
            v.name = verdict_names[i];
            v.check_case = theta < 45 ? "w_o 30 deg" : "w_o 60 deg";
            v.wo = {theta, 0};
            v.state = i < states.size() ? states.begin()[i] : State::right;
            v.sentences = {{"finding", std::string("What of ") + v.name + " is found."}, {"size", "How large it is."}};
            if (v.state == State::skipped) v.sentences = {{"needs", "Needs f."}};
            if (v.state == State::wrong) {
                v.cause = "The cause of " + v.name + ".";
                v.size = theta;
            }
            if (v.name == "density") v.hidden["constant"] = 0.01;
        }
    return out;
}

std::vector<std::string> rows(const std::vector<ScreenLine>& lines) {
    std::vector<std::string> out;
    for (const ScreenLine& line : lines) {
        std::istringstream in((line.state ? "* " : "") + line.head + line.text);
        for (std::string row; std::getline(in, row);) out.push_back(row);
    }
    return out;
}

TEST(Screens, HaveALineForEachRightVerdict) {
    const auto found = rows(screen_of(in_states({})));
    ASSERT_EQ(found.size(), verdict_names.size() + 1);
    EXPECT_EQ(found[0], "* valid: right at 2 of 2 w_o");
    EXPECT_THAT(found.back(), HasSubstr("a constant factor of 1 %"));
}

TEST(Screens, BeginWithTheWrongVerdictItsCauseAndTheNextStep) {
    const auto found = rows(screen_of(in_states({State::right, State::inconclusive, State::skipped, State::wrong})));
    EXPECT_EQ(
        found[0], "* density: wrong at 2 of 2 w_o, worst at w_o 60 deg. What of density is found. How large it is.");
    EXPECT_EQ(found[1], "  Cause: The cause of density.");
    EXPECT_EQ(found[2], "  Next step: --wo 60,0 checks only this w_o.");
    EXPECT_THAT(found[3], HasSubstr("support: inconclusive"));
    EXPECT_THAT(found[4], HasSubstr("valid: right"));
    EXPECT_THAT(found.back(), HasSubstr("skipped: normalised. Needs f."));
}

TEST(Screens, HaveAtMostTwelveRowsAtAnyWidth) {
    for (std::size_t wrong = 0; wrong <= verdict_names.size(); ++wrong)
        for (const std::size_t columns : {0u, 40u, 80u, 120u}) {
            CheckResult result = in_states({});
            for (Verdict& v : result.verdicts)
                if (static_cast<std::size_t>(std::ranges::find(verdict_names, v.name) - verdict_names.begin()) <
                    wrong) {
                    v.state = State::wrong;
                    v.cause = "A cause with its numbers in a sentence of its own, " + v.name + ".";
                }
            const auto found = rows(screen_of(result, columns));
            EXPECT_LE(found.size(), 12u) << wrong << " wrong in " << columns << " columns";
            for (const std::string& row : found)
                if (columns > 0) EXPECT_LE(row.size(), columns) << row;
            std::string all;
            for (const std::string& row : found) all += row + " ";
            if (columns != 40)
                for (std::string_view name : verdict_names) EXPECT_THAT(all, HasSubstr(std::string(name)));
        }
}

TEST(Screens, TellWhatIsExpectedAfterWhatIsNot) {
    CheckResult result = in_states({State::wrong, State::wrong});
    for (Verdict& v : result.verdicts)
        if (v.name == "valid") {
            v.expected = v.waived = true;
            v.why_expected = "it is known";
        } else v.expected = false;
    const auto found = rows(screen_of(result));
    EXPECT_THAT(found[0], HasSubstr("support: wrong at"));
    EXPECT_THAT(found[3], HasSubstr("valid: wrong as waived at 2 of 2 w_o, worst at w_o 60 deg: it is known"));
}

TEST(Screens, AreOfOneSampler) {
    CheckResult result = in_states({});
    EXPECT_TRUE(one_sampler(result));
    result.verdicts.back().arm = "other";
    EXPECT_FALSE(one_sampler(result));
    EXPECT_TRUE(one_sampler(CheckResult{}));
}

}  // namespace screen_test
}  // namespace crescent
