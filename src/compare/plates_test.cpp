// Plates and the page of a comparison: which there are, colours of signed differences, and names that need escapes.
#include "compare/plates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "compare/compare.h"
#include "compare/outputs.h"
#include "compare/page.h"
#include "output/stored_json.h"
#include "tests/support/memory_renders.h"
#include "tests/support/wellformed.h"

namespace crescent {
namespace plates_test {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> plates_of(const MemoryRenders& m, const std::vector<CompareFlag>& flags = {}) {
    std::vector<std::string> out;
    const RenderStats all = m.read(flags);
    for (const auto& [name, picture] : compare_plates(m.plan(flags), all, m.compare(flags))) {
        out.push_back(name);
        EXPECT_GT(picture.width, 100);
        EXPECT_EQ(picture.rgb.size(), static_cast<std::size_t>(picture.width * picture.height) * 3);
    }
    return out;
}

TEST(ComparePlates, ShowWhatHasData) {
    MemoryRenders m;
    m.put("a0", 1);
    m.put("a1", 2);
    EXPECT_THAT(plates_of(m), ::testing::ElementsAre("errors", "renders"));  // about the mean of the arm
    m.put("b0", 3);
    m.put("b1", 4);
    m.put("reference", 5);
    const auto all = plates_of(m, {{{"reference"}, "reference", false, ""}, {{"flip"}, "false", true, ""}});
    EXPECT_THAT(all, ::testing::IsSupersetOf({"renders", "errors", "noise-b-a"}));
    EXPECT_TRUE(std::ranges::any_of(all, [](const std::string& name) { return name.starts_with("bias-"); }));
    EXPECT_THAT(all, Not(::testing::Contains("ladders")));
}

TEST(SignedColours, AreBlueGreyAndOrange) {
    for (const Theme theme : {Theme::dark, Theme::light}) {
        const auto colour = [&](double t) { return plates::diverging(t, theme); };
        const Srgb8 none = colour(0), unknown = colour(std::nan("")), low = colour(-1), high = colour(1);
        EXPECT_NE(none, unknown);
        EXPECT_NEAR(none[0], none[2], 10);
        EXPECT_GT(low[2], low[0]);    // blue
        EXPECT_GT(high[0], high[2]);  // orange
        EXPECT_EQ(colour(5), high);
        EXPECT_EQ(colour(-5), low);
    }
}

TEST(LadderPlates, HaveACurveForEachLadder) {
    CompareResult result;
    for (const double spp : {16.0, 64.0}) {
        ArmResult& arm = result.arms.emplace_back();
        arm.name = "path-" + std::to_string(static_cast<int>(spp));
        arm.spp = spp;
        arm.regions.emplace_back().region = whole_frame;
        arm.regions[0].metrics = {{"rmse", {1 / spp, {{0.9 / spp, 1.1 / spp}}, ""}}};
    }
    result.ladders = ladders_of(result);
    const std::string svg = ladders_svg(result, Theme::light);
    EXPECT_EQ(testing::xml_error(svg), "");
    EXPECT_GT(ladders_plate(result, Theme::dark).width, 100);
}

TEST(ComparePages, EscapeNamesAndListFiles) {
    MemoryRenders m;
    m.put("a<i>0", 1);
    m.put("a<i>1", 2);
    m.put("b0", 3);
    m.put("b1", 4);
    const CompareFlag title{{"title"}, "a < b & \"c\"", false, ""};
    const RenderStats all = m.read({title});
    const Json result = compare_result_json(m.plan({title}), all, m.compare({title}), {});
    const std::string page = compare_html(result, {{"renders", {1, 2, 3}}});
    EXPECT_EQ(compare_html(parse_json(text(result)), {{"renders", {1, 2, 3}}}), page);
    EXPECT_THAT(page, HasSubstr("a &lt; b &amp; &quot;c&quot;"));
    EXPECT_THAT(page, HasSubstr("a&lt;i&gt;0"));
    EXPECT_THAT(page, Not(HasSubstr("a<i>0")));
    EXPECT_THAT(page, HasSubstr("AQID"));  // the bytes of the picture, base64
    EXPECT_THAT(page, Not(HasSubstr("<script src")));
    for (const char* key : {"warnings", "title", "message"}) {
        Json damaged = result;
        damaged[key] = Json::object();
        EXPECT_THROW((void)compare_html(damaged, {}), StoredJsonError) << key;
    }
}

}  // namespace plates_test
}  // namespace crescent
