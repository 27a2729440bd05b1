// A plan from flags, from a file, and from both; mistakes with their places.
#include "compare/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace crescent {
namespace plan_test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ComparePlans : public ScratchFolder {
protected:
    static CompareFlag file_of(const std::string& arm, const std::string& file) {
        return {{"arms", arm, "files"}, file, false, "--arm " + arm + "=" + file};
    }
    static CompareFlag number(const std::string& key, const std::string& value) {
        return {{key}, value, true, "--" + key + " " + value};
    }
    static std::string mistake(const std::vector<CompareFlag>& flags, const std::string& file = {}) {
        return refusal([&] { return plan_of(flags, file); });
    }
};

TEST_F(ComparePlans, FlagsExtendListsAndReplaceOtherValues) {
    const ComparePlan plan = plan_of({file_of("a", "1.exr"), number("alpha", "0.1"), file_of("b", "3.exr"),
        file_of("a", "2.exr"), number("alpha", "0.2"), {{"arms", "b", "spp"}, "64", true, ""}});
    ASSERT_EQ(plan.arms.size(), 2u);
    EXPECT_THAT(plan.arms[0].files, ElementsAre("1.exr", "2.exr"));
    EXPECT_THAT(plan.arms[1].files, ElementsAre("3.exr"));
    EXPECT_EQ(plan.alpha, 0.2);
    EXPECT_EQ(plan.arms[1].spp, 64);
    EXPECT_FALSE(plan.arms[0].spp);
}

TEST_F(ComparePlans, FlagsReplaceTheListsOfAFile) {
    const std::string file = write("c.toml",
        "alpha = 0.05\nreference = 'r.exr'\n[arms.a]\nfiles = ['x.exr', 'y.exr']\n[arms.b]\nfiles = '/abs/b.exr'\n"
        "[regions.lamp]\nbox = [1, 2, 3, 4]\n");
    const ComparePlan alone = plan_of({}, file);
    EXPECT_THAT(alone.arms[0].files, ElementsAre(path("x.exr"), path("y.exr")));  // relative to the file's folder
    EXPECT_THAT(alone.arms[1].files, ElementsAre("/abs/b.exr"));
    EXPECT_THAT(alone.reference, ElementsAre(path("r.exr")));
    EXPECT_EQ(alone.regions.at(0).box.y1, 4);
    const ComparePlan both = plan_of({file_of("a", "z.exr"), number("alpha", "0.2")}, file);
    EXPECT_THAT(both.arms[0].files, ElementsAre("z.exr"));  // relative to the current folder
    EXPECT_EQ(both.arms.size(), 2u);
    EXPECT_EQ(both.alpha, 0.2);
    EXPECT_THAT(compare_arms(file), ElementsAre("a", "b"));
}

TEST_F(ComparePlans, MistakesOfAFileAndOfFlagsAreReportedTogether) {
    const std::string file = write("c.toml", "alhpa = 0.05\n[arms.a]\nfiles = 'x.exr'\n");
    EXPECT_THAT(mistake({number("firefly_k", "-1")}, file),
        AllOf(HasSubstr("c.toml:1:1: "), HasSubstr("did you mean 'alpha'?"), HasSubstr("--firefly_k -1: ")));
    EXPECT_THAT(mistake({file_of("a", "1.exr"), number("trim", "1")}), HasSubstr("--trim 1: "));
    EXPECT_THAT(mistake({file_of("a", "1.exr"), number("trim", "1 2")}), HasSubstr("--trim 1 2: "));
    EXPECT_THAT(mistake({}), HasSubstr("arms"));
}

TEST_F(ComparePlans, AssertionsNameArmsAndRegionsThatExist) {
    const auto with_check = [&](const std::string& check) {
        return mistake({file_of("path", "1.exr"), {{"regions", "lamp", "box"}, "[0, 0, 1, 1]", true, ""},
            {{"assertions", "it", "check"}, check, false, "--assert"}});
    };
    EXPECT_EQ(with_check("rmse.lamp(path) < 1"), "");
    EXPECT_EQ(with_check("var.frame(path) < 1"), "");
    EXPECT_THAT(with_check("rmse.lamp(bath) < 1"), HasSubstr("no arm 'bath'"));
    EXPECT_THAT(with_check("rmse.lump(path) < 1"), HasSubstr("did you mean 'lamp'?"));
    EXPECT_THAT(with_check("rnse.lamp(path) < 1"), HasSubstr("rmse"));
}

TEST_F(ComparePlans, KeysThatContradictEachOtherAreRefused) {
    const CompareFlag a = file_of("a", "1.exr"), same{{"expect"}, "same", false, "--expect same"},
                      reference{{"reference"}, "r.exr", false, "--reference"};
    EXPECT_NE(mistake({a, same}), "");
    EXPECT_EQ(mistake({a, same, reference}), "");
    EXPECT_EQ(mistake({a, same, file_of("b", "2.exr")}), "");
    EXPECT_NE(mistake({a, number("crop", "true"), {{"align"}, "display", false, ""}}), "");
    EXPECT_EQ(mistake({a, number("crop", "true")}), "");
    const CompareFlag box{{"regions", "lamp", "box"}, "[0, 0, 1, 1]", true, ""},
        mask{{"masks", "lamp", "file"}, "m.pfm", false, ""};
    EXPECT_THAT(mistake({a, box, mask}), HasSubstr("'lamp' is a region already"));
}

}  // namespace plan_test
}  // namespace crescent
