// Views decided together: levels by Holm's method, states and exit codes, from p-values that are given.
#include "compare/suite/decide.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compare/suite/suite.h"

namespace crescent {
namespace decide_test {

using ::testing::ElementsAre;

/// A view with these p-values of its means and variances; the variance is `ratio` times that of the baseline.
ViewResult view(const std::string& name, double mean_p, double variance_p = 1, double ratio = 1) {
    ViewResult out;
    out.name = name;
    out.mean_p = mean_p;
    out.variance_p = variance_p;
    out.means.emplace();
    out.means->sentence = "differs";
    out.means->tiles.different = 3;
    out.means->regions.emplace_back().smallest = 0.01;
    VarianceTest& test = out.variances.emplace_back();
    test.region = "frame";
    test.baseline = 1;
    test.candidate = ratio;
    test.welch.p = variance_p;
    return out;
}

std::vector<ViewState> states_of(std::vector<ViewResult> views, SuiteResult* decided = nullptr) {
    Suite suite;
    suite.options.alpha = 0.04;
    SuiteResult result;
    result.views = std::move(views);
    decide(suite, result);
    std::vector<ViewState> out;
    for (const ViewResult& v : result.views) out.push_back(v.state);
    if (decided) *decided = result;
    return out;
}

// p / 0.75 is compared with 0.04 / 3, 0.04 / 2 and 0.04: p with 0.01, 0.015 and 0.03.
TEST(SuiteDecisions, ShareOneLevelByHolmsMethod) {
    SuiteResult found;
    EXPECT_THAT(states_of({view("a", 0.0149), view("b", 0.0299), view("c", 0.0099)}, &found),
        ElementsAre(ViewState::changed, ViewState::changed, ViewState::changed));
    EXPECT_EQ(found.tested_views, 3u);
    EXPECT_THAT(states_of({view("a", 0.0149), view("b", 0.5), view("c", 0.0101)}, &found),
        ElementsAre(ViewState::same, ViewState::same, ViewState::same));
    EXPECT_DOUBLE_EQ(found.views[1].level, 0.04 / 3);
    EXPECT_EQ(found.views[0].means->tiles.different, 0u);  // places without a difference are removed
    EXPECT_THAT(
        states_of({view("a", 0.0151), view("b", 0.0001)}, &found), ElementsAre(ViewState::changed, ViewState::changed));
    EXPECT_EQ(found.views[0].means->tiles.different, 3u);
}

// A quarter of the level 0.04 is for the variances.
TEST(SuiteDecisions, OfVariancesAreNoisierOrImproved) {
    EXPECT_THAT(states_of({view("a", 1, 0.0099, 2)}), ElementsAre(ViewState::noisier));
    EXPECT_THAT(states_of({view("a", 1, 0.0099, 0.5)}), ElementsAre(ViewState::improved));
    EXPECT_THAT(states_of({view("a", 1, 0.0101, 2)}), ElementsAre(ViewState::same));
    EXPECT_THAT(states_of({view("a", 0.001, 0.001, 2)}), ElementsAre(ViewState::changed));
    ViewResult mixed = view("a", 1, 0.004, 0.5);
    mixed.variances.push_back(mixed.variances[0]);
    mixed.variances[1].candidate = 2;
    EXPECT_THAT(states_of({mixed}), ElementsAre(ViewState::noisier));  // in one of its regions
}

// A fifth of the level 0.04 is for the numbers of outlier pixels, over the views that have enough of them: 0.008, or
// 0.004 each of two views; a twentieth then remains for the variances.
TEST(SuiteDecisions, OfOutlierPixelsShareAPartOfTheLevel) {
    ViewResult one = view("a", 1), other = view("b", 1), quiet = view("c", 1, 0.0021, 2);
    one.outliers.p = 0.0079;
    EXPECT_THAT(states_of({one}), ElementsAre(ViewState::changed));
    EXPECT_THAT(states_of({one, view("b", 1), view("c", 1)}),
        ElementsAre(ViewState::changed, ViewState::same, ViewState::same));
    other.outliers.p = 0.0039;
    EXPECT_THAT(states_of({one, other}), ElementsAre(ViewState::same, ViewState::changed));
    EXPECT_THAT(states_of({quiet}), ElementsAre(ViewState::noisier));
    EXPECT_THAT(states_of({one, quiet}), ElementsAre(ViewState::changed, ViewState::same));
}

TEST(SuiteDecisions, AnOutlierRenderHasAShareOfTheLevelAndIsNamedFromOnePerCent) {
    ViewResult rare = view("a", 1), doubtful = view("b", 1);
    rare.outlier_render = {"a.exr", true, 0, 30, 0.0005};
    doubtful.outlier_render = {"b.exr", true, 0, 10, 0.009};
    doubtful.too_few = "in frame: too few";
    doubtful.renders_needed = 99;
    SuiteResult found;
    EXPECT_THAT(states_of({rare, doubtful}, &found), ElementsAre(ViewState::changed, ViewState::too_few));
    EXPECT_THAT(found.views[0].sentence, ::testing::HasSubstr("a.exr does not belong"));
    EXPECT_THAT(found.views[1].sentence, ::testing::HasSubstr("b.exr may not belong"));
    EXPECT_THAT(found.views[1].sentence, ::testing::Not(::testing::HasSubstr("99")));
}

TEST(SuiteDecisions, TooFewRendersDoNotHideADifference) {
    ViewResult same = view("a", 1), changed = view("b", 0.001), improved = view("c", 1, 0.001, 0.5);
    for (ViewResult* v : {&same, &changed, &improved}) v->too_few = "in frame: too few";
    EXPECT_THAT(
        states_of({same, changed, improved}), ElementsAre(ViewState::too_few, ViewState::changed, ViewState::too_few));
}

TEST(SuiteDecisions, DeterministicViewsNeedNoLevel) {
    ViewResult equal = view("a", 1), moved = view("b", 0), missing, added;
    equal.exact = moved.exact = true;
    missing.state = ViewState::missing;
    added.state = ViewState::added;
    SuiteResult found;
    EXPECT_THAT(states_of({equal, moved, missing, added}, &found),
        ElementsAre(ViewState::same, ViewState::changed, ViewState::missing, ViewState::added));
    EXPECT_EQ(found.tested_views, 0u);
}

TEST(SuiteDecisions, TheFirstExitCodeThatAppliesIsTaken) {
    const auto code = [](std::initializer_list<ViewState> states, bool new_baseline = false) {
        SuiteResult result;
        for (const ViewState state : states) result.views.emplace_back().state = state;
        return exit_code(result, new_baseline);
    };
    EXPECT_EQ(code({ViewState::same, ViewState::improved}), 0);
    EXPECT_EQ(code({ViewState::same, ViewState::added}, true), 0);
    EXPECT_EQ(code({ViewState::same, ViewState::added}), 1);
    EXPECT_EQ(code({ViewState::unreadable, ViewState::changed, ViewState::too_few}, true), 2);
    EXPECT_EQ(code({ViewState::too_few, ViewState::same}), 4);
    EXPECT_EQ(code({ViewState::too_few, ViewState::missing}), 1);
    EXPECT_EQ(code({ViewState::too_few, ViewState::noisier}), 1);
    EXPECT_EQ(code({ViewState::too_few, ViewState::added}), 1);
    EXPECT_EQ(code({ViewState::too_few, ViewState::added}, true), 4);
}

}  // namespace decide_test
}  // namespace crescent
