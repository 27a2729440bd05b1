// Patterns of file names: views and wildcards, folders whose names have the characters of patterns, mistakes.
#include "compare/file_pattern.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "compare/plan.h"
#include "compare/suite/suite.h"
#include "compare/suite/suite_file.h"
#include "tests/support/scratch_folder.h"

namespace crescent {
namespace file_pattern_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class FilePatterns : public ScratchFolder {
protected:
    void touch(const std::string& name) {
        fs::create_directories(fs::path(path(name)).parent_path());
        write(name, "x");
    }
    std::vector<std::string> found(const std::string& pattern) const {
        std::vector<std::string> out;
        for (const MatchedFile& file : FilePattern(pattern_in(path(""), pattern), {}, true).find())
            out.push_back(file.view + ":" + (file.wildcards.empty() ? "" : file.wildcards[0]));
        return out;
    }
    static std::optional<MatchedFile> match(const std::string& pattern, const std::string& name) {
        return FilePattern(pattern, {}, true).match(name);
    }
};

TEST_F(FilePatterns, ViewsAndSeedsAreReadFromNames) {
    for (const char* name : {"b/crown-1.exr", "b/crown-12.exr", "b/crown-hall-3.exr", "b/crown.exr", "b/inner/7.exr",
             "b/.hidden-1.exr", "c-1/c.exr", "c-d-2/c.exr"})
        touch(name);
    EXPECT_THAT(found("b/{view}-*.exr"), ElementsAre("crown:1", "crown:12", "crown-hall:3"));
    EXPECT_THAT(found("b/{view}-%d.exr"), ElementsAre("crown:1", "crown:12", "crown-hall:3"));
    EXPECT_THAT(found("b/{view}-?.exr"), ElementsAre("crown:1", "crown-hall:3"));
    EXPECT_THAT(found("b/{view}-[2-9].exr"), ElementsAre("crown-hall:3"));
    EXPECT_THAT(found("b/{view}-[!2-9].exr"), ElementsAre("crown:1"));
    EXPECT_THAT(found("b/{view}/*.exr"), ElementsAre("inner:7"));
    EXPECT_THAT(found("{view}-*/{view}.exr"), ElementsAre("c:1", "c:d-2"));
    EXPECT_THAT(found("{view}/{view}*.exr"), ElementsAre());
    EXPECT_THAT(found("absent/{view}.exr"), ElementsAre());
}

TEST_F(FilePatterns, PathsFollowFromViewsAndWildcards) {
    const auto made = [](const std::string& pattern, const std::string& view, const std::vector<std::string>& with) {
        return FilePattern(pattern, {}, true).path(view, with);
    };
    EXPECT_EQ(made("x/{view}-*.exr", "crown", {"12"}), "x/crown-12.exr");
    EXPECT_EQ(made("/x/{view}/{view}-%03d-[ab].exr", "v", {"1", "a"}), "/x/v/v-1-a.exr");
    EXPECT_EQ(made("x/{view}.exr", "v", {"1"}), std::nullopt);
    EXPECT_TRUE(match("x/{view}-[a-c].exr", "x/crown-b.exr"));
    EXPECT_FALSE(match("x/{view}-[a-c].exr", "x/crown-1.exr"));
    EXPECT_FALSE(match("x/{view}-*.exr", "x/crown/-1.exr"));
}

TEST_F(FilePatterns, CharactersOfFoldersAreLiteral) {
    for (const char* name :
        {"run[1]", "run1", "a*b", "axb", "q?q", "qqq", "feature%2dx", "feature2x", "a{view}b", "a]b"}) {
        touch(std::string(name) + "/base/v-1.exr");
        touch(std::string(name) + "/out/v-1.exr");
        write(std::string(name) + "/s.toml",
            "[suite]\nbaseline = \"base/{view}-*.exr\"\ncandidate = \"out/{view}-*.exr\"\n");
        const std::string folder = path(name);
        const Suite suite = read_suite(folder + "/s.toml", {});
        ASSERT_EQ(suite.views.size(), 1u) << name;
        EXPECT_THAT(suite.views[0].baseline, ElementsAre(folder + "/base/v-1.exr"));
        EXPECT_EQ(baseline_folder(suite), folder + "/base");
        SuiteFlags flags;
        flags.baseline = folder + "/base";
        flags.candidate = folder + "/out";
        EXPECT_THAT(read_suite("", flags).views[0].candidate, ElementsAre(folder + "/out/v-1.exr"));
        write(std::string(name) + "/arms.toml", "[arms.a]\nfiles = \"base/*.exr\"\n");
        const ComparePlan plan = plan_of({}, folder + "/arms.toml");
        EXPECT_THAT(expand(plan.arms[0].files, {}), ElementsAre(folder + "/base/v-1.exr"));
    }
}

TEST_F(FilePatterns, MistakesHaveAPlace) {
    const SourceLocation place{"s.toml", 3, 7};
    const auto mistake = [&](const std::string& pattern) {
        return refusal([&] { return FilePattern(pattern, place, true); });
    };
    EXPECT_THAT(mistake("base/{view}-[z-a].exr"), HasSubstr("s.toml:3:7: "));
    EXPECT_THAT(mistake("base/{view}-[z-a].exr"), HasSubstr("ascending"));
    EXPECT_THAT(mistake(std::string(5000, 'x')), HasSubstr("s.toml:3:7: "));
    EXPECT_THAT(mistake(std::string(100, '*')), HasSubstr("wildcards"));
    EXPECT_EQ(mistake("base/[abc"), "");  // no set without an end, but text
    EXPECT_TRUE(match("base/[abc{view}", "base/[abcv"));
}

TEST_F(FilePatterns, ManyWildcardsTakeLittleTime) {
    std::string pattern, name(250, 'a');
    for (int k = 0; k < 30; ++k) pattern += "*a";
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(match(pattern + "*{view}b", name));
    EXPECT_FALSE(match("{view}*{view}*{view}b", name));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

}  // namespace file_pattern_test
}  // namespace crescent
