// A suite's result as JSON, JUnit and Markdown: states, numbers and limits.
#include "compare/suite/suite_outputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <utility>

#include "compare/suite/suite.h"
#include "output/junit.h"

namespace crescent {
namespace suite_outputs_test {

using ::testing::HasSubstr;

/// One view in each state, named after it.
SuiteResult every_state() {
    SuiteResult out;
    for (std::size_t k = view_state_names.size(); k-- > 0;) {
        out.views.emplace_back().name = view_state_names[k];
        out.views.back().state = static_cast<ViewState>(k);
    }
    return out;
}

TEST(SuiteOutputs, ListTheMostSevereViewsFirst) {
    SuiteResult result = every_state();
    result.views.emplace_back().name = "a";
    result.views.back().state = ViewState::changed;
    std::vector<std::string> names;
    for (const ViewResult* view : by_state(result)) names.push_back(view->name);
    EXPECT_EQ(names,
        (std::vector<std::string>{
            "unreadable", "a", "changed", "noisier", "missing", "new", "too few renders", "improved", "same"}));
}

TEST(SuiteOutputs, ListTheLargestChangesFirst) {
    SuiteResult result;
    for (const auto& [name, change] : {std::pair{"a", 1.02}, std::pair{"b", 1.3}, std::pair{"c", 0.5}}) {
        ViewResult& view = result.views.emplace_back();
        view.name = name;
        view.state = ViewState::changed;
        MeanTest& test = view.means.emplace().regions.emplace_back();
        test.b = 1;
        test.a = change;
        test.differs = true;
    }
    result.views[0].means->tiles_found.push_back({.a = 1.4, .b = 1});
    ViewResult& failing = result.views.emplace_back();
    failing.name = "d";
    failing.state = ViewState::changed;
    failing.non_finite = "1 pixel is not finite";
    std::vector<std::string> names;
    for (const ViewResult* view : by_state(result)) names.push_back(view->name);
    EXPECT_EQ(names, (std::vector<std::string>{"d", "c", "a", "b"}));
}

TEST(SuiteOutputs, PlatesHaveNamesThatABuildServerTakes) {
    SuiteResult result = every_state();
    for (ViewResult& view : result.views) view.pictures.baseline = view.pictures.difference = {1};
    result.views[1].name = "a:b/\"<c>\n";             // improved
    result.views.back().name = "$(x) \xc3\xa9?*|\r";  // unreadable: the first
    const auto plates = suite_plates(result);
    ASSERT_EQ(plates.size(), 12u);  // two of each view, not of the same and the improved one
    EXPECT_EQ(plates[0].first, "plates/1---x---------baseline.png");
    EXPECT_EQ(plates[3].first, "plates/2-changed-difference.png");
    for (const auto& [name, bytes] : plates)
        EXPECT_EQ(name.find_first_of("\":<>|*?\r\n\\ "), std::string::npos) << name;
}

TEST(SuiteOutputs, JsonNamesNoViewIdenticalWhoseOtherChannelsDiffer) {
    SuiteResult result;
    ViewResult& view = result.views.emplace_back();
    view.means.emplace().identical = true;
    EXPECT_EQ(nlohmann::json::parse(suite_json({}, result, false, {}))["views"][0]["identical"], true);
    view.other_channels = "A in 1 pixel";
    EXPECT_EQ(nlohmann::json::parse(suite_json({}, result, false, {}))["views"][0]["identical"], false);
}

TEST(SuiteOutputs, JunitFailsErrsAndSkips) {
    EXPECT_THAT(junit_text(suite_report({}, every_state(), false)),
        HasSubstr("tests=\"8\" failures=\"4\" errors=\"2\" skipped=\"0\""));
    EXPECT_THAT(junit_text(suite_report({}, every_state(), true)),
        HasSubstr("tests=\"8\" failures=\"3\" errors=\"2\" skipped=\"1\""));
}

TEST(SuiteOutputs, JsonHasTheNumbersOfEachView) {
    SuiteResult result = every_state();
    ViewResult& view = result.views[0];
    view.mean_p = 0.25;
    view.renders_needed = 12;
    view.candidate_renders = 4;
    MeanTest& test = view.means.emplace().regions.emplace_back();
    test.region = "frame";
    test.a = 3;
    test.b = 2;
    test.joint_p = 0.5;
    test.smallest = 0.125;
    view.variances.emplace_back().region = "frame";
    view.variances[0].why = "heavy tail";
    const nlohmann::json json = nlohmann::json::parse(suite_json({}, result, true, {}));
    EXPECT_EQ(json["exit_code"], 2);
    EXPECT_EQ(json["counts"]["changed"], 1);
    const nlohmann::json& first = json["views"][0];
    EXPECT_EQ(first["state"], "same");
    EXPECT_EQ(first["p"]["means"], 0.25);
    EXPECT_EQ(first["p"]["variances"], nullptr);
    EXPECT_EQ(first["renders_needed"], 12);
    EXPECT_EQ(first["renders"]["candidate"], 4);
    EXPECT_EQ(first["means"]["frame"]["candidate"], 3);
    EXPECT_EQ(first["means"]["frame"]["smallest"], 0.125);
    EXPECT_FALSE(first["variances"]["frame"].contains("p"));
}

TEST(SuiteOutputs, MarkdownStaysBelowSixtyKilobytesAndEscapesNames) {
    SuiteResult result;
    for (int k = 0; k < 3000; ++k) {
        ViewResult& view = result.views.emplace_back();
        view.name = "a|b<i>@all" + std::to_string(k);
        view.state = ViewState::changed;
        view.sentence = std::string(300, 'x');
    }
    const std::string text = suite_markdown({}, result, {});
    EXPECT_LT(text.size(), 60'000u);
    EXPECT_THAT(text, HasSubstr("a\\|b&lt;i>@&#8203;all"));
    EXPECT_THAT(text, HasSubstr("more; the report has them"));
}

TEST(SuiteOutputs, MarkdownLeavesEqualViewsOut) {
    const std::string text = suite_markdown({}, every_state(), {});
    for (const char* name : {"changed", "noisier", "missing", "improved"}) EXPECT_THAT(text, HasSubstr(name));
    SuiteResult same;
    same.views.emplace_back().name = "crown";
    EXPECT_EQ(suite_markdown({}, same, {}).find("crown"), std::string::npos);
}

}  // namespace suite_outputs_test
}  // namespace crescent
