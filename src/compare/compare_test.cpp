// A comparison as a whole: costs from the files, the level of each pair, assertions, and the state that follows.
#include "compare/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/support/memory_renders.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/written_exr.h"

namespace crescent {
namespace compare_test {

using ::testing::HasSubstr;
using State = CompareResult::State;

const CompareFlag same{{"expect"}, "same", false, ""}, no_flip{{"flip"}, "false", true, ""},
    reference{{"reference"}, "reference", false, ""};
CompareFlag check(const std::string& text) { return {{"assertions", "it", "check"}, text, false, ""}; }

/// Three renders of each of two arms, of which b is brighter by a factor.
MemoryRenders two_arms(float factor) {
    MemoryRenders m;
    for (std::uint32_t k = 0; k < 3; ++k) {
        m.put("a" + std::to_string(k), k);
        Render& b = m.put("b" + std::to_string(k), 10 + k);
        for (auto* plane : {&b.r, &b.g, &b.b})
            for (float& x : *plane) x *= factor;
    }
    return m;
}

TEST(Comparisons, HaveTheMeanCostOfTheirFiles) {
    MemoryRenders m = two_arms(1);
    m.renders["a0"].seconds = 1;
    m.renders["a1"].seconds = 2;
    m.renders["a2"].seconds = 6;
    m.renders["b0"].spp = 16;
    const CompareResult r = m.compare();
    EXPECT_EQ(r.arms[0].seconds, 3);
    EXPECT_FALSE(r.arms[1].spp);  // two files do not state it
    m.renders["a0"].spp = m.renders["a1"].spp = m.renders["a2"].spp = 16;
    EXPECT_EQ(m.compare().arms[0].spp, 16);
    EXPECT_EQ(m.compare({{{"arms", "a", "spp"}, "64", true, ""}}).arms[0].spp, 64);
}

TEST(Comparisons, ShareTheirLevelBetweenAllPairs) {
    MemoryRenders m = two_arms(1);
    const double alone = m.compare().bias.at(0).place_alpha;
    m.put("reference", 99);
    const CompareResult r = m.compare({reference, no_flip});
    ASSERT_EQ(r.bias.size(), 3u);
    for (const BiasResult& b : r.bias) EXPECT_NEAR(b.place_alpha, alone / 3, 1e-15);
    EXPECT_EQ(r.reference_error.size(), 1u);
    EXPECT_EQ(r.noise.size(), 1u);
}

TEST(Comparisons, StateWhatFailsBeforeWhatIsOpen) {
    const CompareResult open = two_arms(1).compare({same}), fails = two_arms(2).compare({same});
    EXPECT_EQ(open.state, State::inconclusive);  // three renders cannot show 1 %
    EXPECT_EQ(fails.state, State::fails);
    EXPECT_TRUE(fails.differs());
    EXPECT_EQ(two_arms(2).compare().state, State::holds);  // a difference is reported, not expected to be absent
    EXPECT_EQ(two_arms(1).compare({same, check("y_mean.frame(a) > 9")}).state, State::fails);
}

TEST(Comparisons, AssertionsOfWhatWasNotMeasuredDoNotPass) {
    const CompareResult r = two_arms(1).compare({check("rmse.frame(a) < 1e9")});
    EXPECT_FALSE(r.assertions.at(0).pass);
    EXPECT_TRUE(std::isnan(r.assertions[0].measured));
    EXPECT_EQ(r.warnings.size(), 1u);
    EXPECT_EQ(r.state, State::fails);
    EXPECT_TRUE(two_arms(2).compare({check("y_mean.frame(b) > y_mean.frame(a)")}).assertions.at(0).pass);
}

using CompareFiles = ScratchFolder;

TEST_F(CompareFiles, AllOutputsAppearAtOnce) {
    for (int k = 0; k < 4; ++k) {
        WrittenExr exr;
        exr.constant = {{"A", static_cast<float>(k)}};
        exr.channels = {"R", "G", "B"};
        exr.data = exr.display = {{k, 0}, {20 + k, 12}};
        exr.write(path((k < 2 ? "a" : "b") + std::to_string(k) + ".exr"));
    }
    const auto plan = [&](const std::string& more) {
        return plan_of({{{"arms", "a", "files"}, path("a?.exr"), false, ""},
            {{"arms", "b", "files"}, path("b?.exr"), false, ""}, {{"align"}, more, false, ""}});
    };
    ProgressMonitor monitor;
    std::string summary;
    EXPECT_THROW((void)compare_renders(plan("windows"), {path("out")}, {}, monitor, summary), InputError);
    EXPECT_FALSE(std::filesystem::exists(path("out/metrics.json")));
    const CompareResult r = compare_renders(plan("display"), {path("out")}, {}, monitor, summary);
    for (const char* file : {"metrics.json", "metrics.csv", "junit.xml", "report.html", "plates/renders.png"})
        EXPECT_TRUE(std::filesystem::exists(path("out/") + file)) << file;
    EXPECT_EQ(r.arms.size(), 2u);
    EXPECT_THAT(summary, HasSubstr("frame (273 pixels)"));
}

}  // namespace compare_test
}  // namespace crescent
