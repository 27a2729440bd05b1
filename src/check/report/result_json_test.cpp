// A result survives its JSON: the page, the table and JUnit of what was read are those of the result.
#include "check/report/result_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "base/errors.h"
#include "check/report/html.h"
#include "check/report/print.h"

namespace crescent {
namespace result_json_test {

using ::testing::HasSubstr;

/// A result that sets every member which a page reads.
CheckResult full() {
    CheckResult out;
    out.alpha = 0.01;
    out.tests = 42;
    out.screened = 3;
    out.confirmed = 1;
    out.questions = 1000;
    for (const State state : {State::right, State::wrong, State::inconclusive, State::skipped, State::error}) {
        Verdict& v = out.verdicts.emplace_back();
        v.arm = state == State::error ? "other" : "made";
        v.check_case = "w_o 45 deg az 0";
        v.name = "density";
        v.state = state;
        v.sentences = {{"size", "What was found."}, {"place", "And where."}};
        v.expected = state != State::wrong;
        v.wo = {45, 0};
        v.size = 0.125;
    }
    Verdict& right = out.verdicts[0];
    right.hidden = {{"constant", 0.02}, {"leak", 0.01}};
    right.nothing = 0.3;
    right.outside = 0.05;
    right.evidence["would_have_found"] = right.hidden;
    Verdict& wrong = out.verdicts[1];
    wrong.cause = "A factor of 2.";
    wrong.integral = 0.5;
    wrong.place = "u = (0, 1)";
    wrong.why_expected = "known";
    out.verdicts[3].sentences[0].technique = 2;
    out.verdicts[2].next = {NextStep::Kind::more_draws, 3, false};
    out.verdicts[4].first_failure = true;
    out.left_out = {{"made", "w_o 45 deg az 0", {"density"}, "No time was left."}};
    out.unmet = {"nothing is wrong"};
    out.devices = {{"made", {.name = "a device", .driver = "a driver", .precision = "single"}}};
    BinHistogram& map = out.maps.emplace_back();
    map.arm = "made";
    map.check_case = "w_o 45 deg az 0";
    map.coordinates = "theta and phi";
    map.rings = 1;
    map.sectors = 2;
    map.observed = {3, 5};
    map.expected = {4, 4.5};
    map.sd = {2, 2.25};
    map.edges = {0, 1};
    map.ring_labels[2] = "half";
    LineHistogram& line = out.lines.emplace_back();
    line.arm = "made";
    line.check_case = "w_o 45 deg az 0";
    line.axis = "x";
    line.edges = {0, 1, 2};
    line.observed = {3, 5};
    line.expected = {4, 4};
    line.entries = true;
    WeightHistogram& weights = out.weights.emplace_back();
    weights.arm = "made";
    weights.check_case = "w_o 45 deg az 0";
    weights.log10_edges = {0, 1};
    weights.counts = {7};
    weights.zeros = 2;
    weights.k = 0.5;
    weights.exceedances = 5;
    weights.threshold = 1;
    weights.sigma = 2;
    weights.rose_p = {0, 1, 0};
    weights.rose_f = {0, 2, 1};
    set_state(out);
    return out;
}

TEST(StoredResult, HasThePageAndTableOfTheResult) {
    const CheckResult result = full();
    const ResultSource source{"1.2", "abc", "crescent check"};
    const StoredResult read = read_verdict_json(verdict_json(result, source), "check.json");
    EXPECT_EQ(verdict_html(read.result, read.source), verdict_html(result, source));
    EXPECT_EQ(verdict_table(read.result, true), verdict_table(result, true));
    EXPECT_EQ(verdict_json(read.result, read.source), verdict_json(result, source));
}

TEST(StoredResult, TakesAMessageWithoutItsListAsOneSentence) {
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(verdict_json(full()));
    json["verdicts"][1].erase("sentences");
    const Verdict read = read_verdict_json(json.dump(), "check.json").result.verdicts[1];
    EXPECT_EQ(read.sentences.size(), 1u);
    EXPECT_EQ(read.message(), "What was found. And where.");
}

TEST(StoredResult, ReadsNumbersThatAreNotFinite) {
    CheckResult result = full();
    result.weights[0].k = std::numeric_limits<double>::quiet_NaN();
    result.verdicts[1].size = std::numeric_limits<double>::infinity();
    const StoredResult read = read_verdict_json(verdict_json(result), "check.json");
    EXPECT_TRUE(std::isnan(read.result.weights[0].k));
}

/// The message of the error of a changed file.
std::string refusal(const std::string& from, const std::string& to) {
    std::string text = verdict_json(full());
    const std::size_t place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    text.replace(place, from.size(), to);
    try {
        read_verdict_json(text, "check.json");
        return "";
    } catch (const InputError& error) { return error.what(); }
}

TEST(StoredResult, RefusesOtherTexts) {
    EXPECT_THAT(refusal("crescent check 3", "crescent check 9"), HasSubstr("check.json: "));
    EXPECT_THAT(refusal("\"state\": \"wrong\"", "\"state\": \"good\""), HasSubstr("expected a state"));
    EXPECT_THAT(
        refusal("\"rings\": 1", "\"rings\": 1000000"), HasSubstr("maps[0]: expected lists as long as the bins"));
    EXPECT_THAT(refusal("\"alpha\": 0.01", "\"alpha\": []"), HasSubstr("alpha: expected a number"));
    EXPECT_THAT(refusal("{", "[" + std::string(1000, '[')), HasSubstr("check.json: "));
    EXPECT_EQ(refusal("What was found", "What else was found"), "");
}

}  // namespace result_json_test
}  // namespace crescent
