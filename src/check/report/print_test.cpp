// A result as JSON, JUnit, table and page: its states and numbers; times are apart.
#include "check/report/print.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "check/report/html.h"
#include "check/report/result_json.h"
#include "output/junit.h"
#include "output/sarif.h"

namespace crescent {
namespace print_test {

using ::testing::HasSubstr;
using ::testing::Not;

/// One verdict in each state, of two arms at one w_o each.
CheckResult every_state() {
    CheckResult out;
    out.alpha = 0.001;
    out.tests = 42;
    for (const State state : {State::right, State::wrong, State::inconclusive, State::skipped, State::error}) {
        Verdict& v = out.verdicts.emplace_back();
        v.arm = state == State::error ? "other" : "made";
        v.check_case = "w_o <45> deg";
        v.name = "density";
        v.state = state;
        v.sentences = {{"size", "What was found."}, {"place", "And where."}};
        v.seconds = 2.5;
        v.expected = state == State::right || state == State::skipped;
        v.evidence["p"] = 0.25;
    }
    set_state(out);
    return out;
}

TEST(ResultAsJson, HasEachVerdictWithItsEvidence) {
    const nlohmann::json json = nlohmann::json::parse(verdict_json(every_state(), {"1.2", "", "check"}));
    EXPECT_EQ(json["state"], "wrong");
    EXPECT_EQ(json["as_expected"], false);
    EXPECT_EQ(json["tests"], 42);
    EXPECT_EQ(json["version"], "1.2");
    EXPECT_FALSE(json.contains("commit"));
    ASSERT_EQ(json["verdicts"].size(), 5u);
    EXPECT_EQ(json["verdicts"][2]["state"], "inconclusive");
    EXPECT_EQ(json["verdicts"][0]["evidence"]["p"], 0.25);
    EXPECT_EQ(json["verdicts"][0]["message"], "What was found. And where.");
    EXPECT_EQ(json["verdicts"][0]["sentences"][1], nlohmann::json({{"what", "place"}, {"text", "And where."}}));
    EXPECT_EQ(json["requested"].size(), 2u);  // arms and cases
}

TEST(ResultAsJson, HasNoTimes) {
    CheckResult fast = every_state(), slow = every_state();
    slow.verdicts[0].seconds = 9;
    slow.verdicts[0].timed_message = "Slow.";
    EXPECT_EQ(verdict_json(fast), verdict_json(slow));
}

TEST(ResultAsJunit, HasACaseForEachVerdict) {
    CheckResult result = every_state();
    EXPECT_THAT(junit_text(verdict_report(result)), HasSubstr("tests=\"5\" failures=\"2\" errors=\"1\" skipped=\"1\""));
    EXPECT_THAT(junit_text(verdict_report(result)), HasSubstr("message=\"wrong: What was found.\""));
    Verdict& wrong = result.verdicts[1];
    wrong.waived = wrong.expected = true;
    wrong.why_expected = "it is known";
    result.unmet = {"an expectation"};
    EXPECT_THAT(junit_text(verdict_report(result)), HasSubstr("tests=\"6\" failures=\"2\" errors=\"1\" skipped=\"1\""));
}

TEST(ResultOfADevice, NamesItInEveryFile) {
    CheckResult result = every_state();
    result.devices = {{"made", {.name = "a device", .driver = "Mesa <1>", .precision = "single"}}};
    const nlohmann::json devices = nlohmann::json::parse(verdict_json(result))["devices"];
    EXPECT_EQ(devices,
        nlohmann::json::array(
            {{{"arm", "made"}, {"name", "a device"}, {"driver", "Mesa <1>"}, {"precision", "single"}}}));
    const char* text = "a device, Mesa &lt;1&gt;, single precision";
    EXPECT_THAT(junit_text(verdict_report(result)), HasSubstr(std::string("name=\"device of made\" value=\"") + text));
    EXPECT_THAT(verdict_html(result), HasSubstr(text));
    EXPECT_THAT(verdict_html(every_state()), Not(HasSubstr("evaluated on")));
}

TEST(ResultAsSarif, HasWhatFailsAtThePlaceOfTheSampler) {
    CheckResult result = every_state();
    const nlohmann::json sarif = nlohmann::json::parse(sarif_text(verdict_report(result, {"a b.py", 7}, "1.2")));
    EXPECT_EQ(sarif["version"], "2.1.0");
    const nlohmann::json& results = sarif["runs"][0]["results"];
    ASSERT_EQ(results.size(), 3u);  // wrong, inconclusive, error
    EXPECT_EQ(results[0]["ruleId"], result.verdicts[1].name);
    EXPECT_EQ(results[0]["level"], "error");
    const nlohmann::json& place = results[0]["locations"][0]["physicalLocation"];
    EXPECT_EQ(place["artifactLocation"]["uri"], "a%20b.py");
    EXPECT_EQ(place["region"]["startLine"], 7);
    EXPECT_EQ(results[1]["level"], "warning");
    EXPECT_EQ(results[2]["level"], "error");
    result.verdicts[1].waived = true;
    EXPECT_EQ(nlohmann::json::parse(sarif_text(verdict_report(result)))["runs"][0]["results"].size(), 2u);
}

TEST(ResultAsTable, HasTheWorstStateOfEachArm) {
    const std::string table = verdict_table(every_state());
    const std::size_t made = table.find("\nmade "), other = table.find("\nother ");
    ASSERT_NE(made, std::string::npos);
    ASSERT_NE(other, std::string::npos);
    EXPECT_THAT(table.substr(made + 1, table.find('\n', made + 1) - made), HasSubstr(" wrong "));
    EXPECT_THAT(table.substr(other + 1, table.find('\n', other + 1) - other), HasSubstr(" error "));
}

TEST(ResultAsPage, EscapesAndListsEveryCase) {
    const std::string page = verdict_html(every_state(), {});
    EXPECT_THAT(page, HasSubstr("w_o &lt;45&gt; deg"));
    EXPECT_THAT(page, Not(HasSubstr("w_o <45> deg")));
    for (const char* state : {"wrong", "inconclusive", "error"}) EXPECT_THAT(page, HasSubstr(state));
    CheckResult with_map = every_state();
    BinHistogram& map = with_map.maps.emplace_back();
    map.arm = "made";
    map.check_case = "w_o <45> deg";
    map.rings = 1;
    map.sectors = 2;
    map.observed = {10, 20};
    map.expected = {12, 18};
    map.edges = {0, 1};
    EXPECT_GT(verdict_html(with_map, {}).size(), page.size());
}

TEST(NextSteps, NameTheFlagOrTheCall) {
    Verdict v;
    EXPECT_EQ(next_step_text(v), "");
    v.next = {NextStep::Kind::more_draws, 0};
    EXPECT_THAT(next_step_text(v), HasSubstr("--full"));
    EXPECT_THAT(next_step_text(v, FrontEnd::python), HasSubstr("full=True"));
    v.next = {NextStep::Kind::heavier_pdf, 0};
    EXPECT_THAT(next_step_text(v, FrontEnd::cpp), Not(HasSubstr("--")));
    EXPECT_THAT(one_wo_text({60, 250}, FrontEnd::command_line), HasSubstr("--wo 60,250"));
    EXPECT_THAT(one_wo_text({60, 250}, FrontEnd::cpp), HasSubstr("{{60, 250}}"));
}

}  // namespace print_test
}  // namespace crescent
