// The state of a call from the states of its verdicts.
#include "check/verdict.h"

#include <gtest/gtest.h>

#include <set>

namespace crescent {
namespace verdict_test {

CheckResult of(const std::vector<State>& states) {
    CheckResult out;
    for (const State state : states) out.verdicts.emplace_back().state = state;
    set_state(out);
    return out;
}

TEST(StateOfACall, IsThatOfItsWorstVerdict) {
    EXPECT_EQ(of({}).state, State::right);
    EXPECT_EQ(of({State::right, State::skipped}).state, State::right);
    EXPECT_EQ(of({State::inconclusive, State::right}).state, State::inconclusive);
    EXPECT_EQ(of({State::inconclusive, State::error}).state, State::error);
    EXPECT_EQ(of({State::error, State::wrong, State::inconclusive}).state, State::wrong);
}

TEST(StateOfACall, DoesNotCountWhatIsWaived) {
    CheckResult r = of({State::wrong, State::inconclusive});
    r.verdicts[0].waived = true;
    set_state(r);
    EXPECT_EQ(r.state, State::inconclusive);
    r.unmet = {"an expectation that can go"};
    set_state(r);
    EXPECT_EQ(r.state, State::wrong);
    EXPECT_FALSE(r.as_expected);
}

TEST(StateOfACall, IsAsExpectedIfEachVerdictIs) {
    CheckResult r = of({State::wrong, State::right});
    EXPECT_TRUE(r.as_expected);  // a planted fault is expected to be found
    r.verdicts[1].expected = false;
    set_state(r);
    EXPECT_FALSE(r.as_expected);
    r.verdicts[1].waived = true;
    set_state(r);
    EXPECT_TRUE(r.as_expected);
}

TEST(VerdictNames, AreDifferentAndHaveAQuestion) {
    EXPECT_EQ(std::set<std::string_view>(verdict_names.begin(), verdict_names.end()).size(), verdict_names.size());
    EXPECT_EQ(verdict_questions.size(), verdict_names.size());
    Verdict v;
    note_first_failure("it ended", v);
    EXPECT_TRUE(v.first_failure);
    EXPECT_EQ(v.evidence["first_fault"], "it ended");
    EXPECT_EQ(word(State::inconclusive), "inconclusive");
}

}  // namespace verdict_test
}  // namespace crescent
