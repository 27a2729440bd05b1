// The manifest of a baseline: it is written and read again; what a merge or a stranger may have written is refused.
#include "compare/suite/manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace crescent {
namespace manifest_test {

using ::testing::HasSubstr;

class Manifests : public ScratchFolder {
protected:
    static std::string with_view(const std::string& entry) {
        return "{\"format\": \"crescent baseline 1\", \"views\": {\"a\": " + entry + "}}";
    }
    static std::string with_file(const std::string& name) {
        return with_view("{\"renders\": 1, \"files\": [{\"file\": \"" + name +
            "\", \"xxh3_128\": \"0123456789abcdef0123456789abcdef\"}]}");
    }
    static std::string mistake(const std::string& text) {
        return refusal([&] { return parse_manifest(text, "base/baseline.json"); });
    }
};

TEST_F(Manifests, AreWrittenAndReadAgain) {
    const Manifest read = parse_manifest(with_file("x/a-1.exr"), "base/baseline.json");
    EXPECT_EQ(read.folder, "base");
    EXPECT_EQ(read.views.at("a").files.at(0).name, "x/a-1.exr");
    EXPECT_EQ(read.views.at("a").renders, 1u);
    const Manifest again = parse_manifest(manifest_text(read), "base/baseline.json");
    EXPECT_EQ(manifest_text(again), manifest_text(read));
}

TEST_F(Manifests, MergesByHandAreRefused) {
    const std::string good = with_file("a.exr");
    EXPECT_THAT(mistake("{\n<<<<<<< HEAD\n" + good.substr(1)), HasSubstr("baseline.json:2:1: "));
    EXPECT_THAT(mistake("{\"format\": \"crescent baseline 1\", \"views\": {\"a\": 1, \"a\": 2}}"), HasSubstr("twice"));
    EXPECT_THAT(mistake("version https://git-lfs.github.com/spec/v1\n"), HasSubstr("git lfs pull"));
    EXPECT_NE(mistake(good.substr(0, good.size() / 2)), "");
}

TEST_F(Manifests, OddTypesNamesAndDepthsAreRefused) {
    for (const char* text : {"", "[]", "1", "{}", "{\"format\": 1}", "{\"format\": \"crescent baseline 1\"}",
             "{\"format\": \"crescent baseline 1\", \"views\": []}"})
        EXPECT_NE(mistake(text), "") << text;
    for (const char* entry : {"1", "[]", "{}", "{\"renders\": -1, \"files\": []}",
             "{\"renders\": 1e300, \"files\": []}", "{\"renders\": 1, \"files\": {}}",
             "{\"renders\": 1, \"files\": [1]}", "{\"renders\": 1, \"files\": [{\"file\": 1, \"xxh3_128\": \"\"}]}",
             "{\"renders\": 1, \"files\": [{\"file\": \"a\", \"xxh3_128\": \"0\"}]}"})
        EXPECT_NE(mistake(with_view(entry)), "") << entry;
    for (const char* name : {"", "/etc/passwd", "../a.exr", "x/../../a.exr", "a\\u0000b"})
        EXPECT_NE(mistake(with_file(name)), "") << name;
    EXPECT_NE(mistake(with_view(std::string(100'000, '[') + std::string(100'000, ']'))), "");
    EXPECT_EQ(mistake(with_file("x/a.exr")), "");
}

}  // namespace manifest_test
}  // namespace crescent
