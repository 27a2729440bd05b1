// A comparison as JSON, CSV, JUnit and assertions: the numbers and states of its result.
#include "compare/outputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

#include "output/junit.h"
#include "output/sarif.h"
#include "tests/support/memory_renders.h"

namespace crescent {
namespace outputs_test {

using ::testing::HasSubstr;

CompareFlag check(const std::string& name, const std::string& text) {
    return {{"assertions", name, "check"}, text, false, ""};
}

/// Two arms of three renders, b twice as bright; the first assertion holds.
struct Compared {
    explicit Compared(std::vector<CompareFlag> flags = {}) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            renders.put("a" + std::to_string(k), k).seconds = 1 + k;
            Render& b = renders.put("b" + std::to_string(k), 10 + k);
            for (auto* plane : {&b.r, &b.g, &b.b})
                for (float& x : *plane) x *= 2;
        }
        renders.renders["b0"].spp = 16;
        plan = renders.plan(flags);
        all = renders.read(flags);
        result = renders.compare(flags);
    }
    nlohmann::json json() const { return nlohmann::json::parse(text(compare_result_json(plan, all, result, {}))); }
    MemoryRenders renders;
    ComparePlan plan;
    RenderStats all;
    CompareResult result;
};

TEST(CompareJson, HasTheNumbersOfTheResult) {
    const Compared c({check("bright", "y_mean.frame(b) > y_mean.frame(a)"), check("dark", "y_mean.frame(b) < 1")});
    const nlohmann::json json = c.json();
    EXPECT_EQ(json["state"], "fails");
    EXPECT_EQ(json["arms"].size(), 2u);
    const auto& b = json["arms"][1]["regions"]["frame"];
    EXPECT_NEAR(b["metrics"]["y_mean"]["value"], 2, 0.05);
    EXPECT_EQ(b["metrics"]["rmse"]["value"], nullptr);
    EXPECT_EQ(b["pixels"], 256);
    EXPECT_EQ(json["arms"][0]["seconds"], 2);    // the mean over its files
    EXPECT_EQ(json["arms"][1]["spp"], nullptr);  // one file of three states it
    EXPECT_EQ(json["reference"], nullptr);
    EXPECT_EQ(json["assertions"][0]["pass"], true);
    EXPECT_EQ(json["assertions"][1]["pass"], false);
    EXPECT_EQ(json["assertions"][1]["bound"], 1);
    EXPECT_EQ(json["bias"].size(), 1u);
}

TEST(CompareCsv, HasARowForEachMetric) {
    const Compared c;
    const std::string csv = compare_csv(c.result);
    std::size_t metrics = 0;
    for (const ArmResult& arm : c.result.arms) metrics += arm.regions[0].metrics.size();
    EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), metrics + 1);
    EXPECT_THAT(csv, HasSubstr("\nb,3,frame,y_mean,"));
    EXPECT_THAT(csv, HasSubstr("\na,3,frame,rmse,,,,no reference\r\n"));
}

TEST(CompareJunit, HasACaseForEachClaim) {
    const auto junit = [](const std::vector<CompareFlag>& flags) {
        const Compared c(flags);
        return junit_text(compare_report(c.plan, c.result));
    };
    const CompareFlag same{{"expect"}, "same", false, ""}, bright = check("bright", "y_mean.frame(b) > 1");
    EXPECT_THAT(junit({bright}), HasSubstr("tests=\"1\" failures=\"0\""));
    EXPECT_THAT(junit({bright, check("dark", "y_mean.frame(b) < 1"), same}), HasSubstr("tests=\"3\" failures=\"2\""));
}

TEST(CompareSarif, HasAResultForEachClaimThatFails) {
    const Compared c({check("bright", "y_mean.frame(b) > 1"), check("dark", "y_mean.frame(b) < 1")});
    const Json sarif = Json::parse(sarif_text(compare_report(c.plan, c.result, "compare.toml")));
    const Json& run = sarif["runs"][0];
    EXPECT_EQ(run["tool"]["driver"]["rules"].size(), 2u);
    ASSERT_EQ(run["results"].size(), 1u);
    EXPECT_EQ(run["results"][0]["ruleId"], "dark");
    EXPECT_EQ(run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"], "compare.toml");
    ComparePlan of_file = c.plan;
    for (std::size_t k = 0; k < of_file.assertions.size(); ++k)
        of_file.assertions[k].location = {"compare.toml", static_cast<unsigned>(10 * k + 7), 1};
    const Json placed =
        Json::parse(sarif_text(compare_report(of_file, c.result, "compare.toml")))["runs"][0]["results"];
    EXPECT_EQ(placed[0]["locations"][0]["physicalLocation"]["region"]["startLine"], 17);
}

}  // namespace outputs_test
}  // namespace crescent
