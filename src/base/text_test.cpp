// Text for terminals against escapes written out by hand, and 20 000 random texts whose output must have no control
// characters; shell words against sh, which reads them back; nearest() of base/errors.h on near and far words.
#include "base/text.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "base/errors.h"

namespace crescent {
namespace text_test {

TEST(Text, NothingThatMovesACursorIsPrinted) {
    EXPECT_EQ(printable("a\x1b[31mb\a\n\x7f"), "a\\x1b[31mb\\x07\\x0a\\x7f");
    EXPECT_EQ(printable("\xc2\x9b"
                        "31m"),
        "\\u{9b}31m");  // CSI of one character
    EXPECT_EQ(printable("\xe2\x80\xae"
                        "abc"),
        "\\u{202e}abc");  // right to left
    EXPECT_EQ(printable("na\xefve \xc3\xa9\xe2\x82\xac"), "na\\xefve \xc3\xa9\xe2\x82\xac");
}

TEST(Text, HasNoControlCharacterForAnyBytes) {
    std::mt19937 random(7);
    for (int round = 0; round < 20000; ++round) {
        std::string text(random() % 12, ' ');
        for (char& c : text)
            c = static_cast<char>(round % 2 ? random() : "\x1b\xc2\x9b\xe2\x80\xae\xf0\x80[a\n"[random() % 11]);
        const std::string shown = printable_lines(text);
        for (std::size_t k = 0; k < shown.size(); ++k) {
            const auto byte = static_cast<unsigned char>(shown[k]);
            ASSERT_TRUE(byte == '\n' || byte == '\t' || (byte >= 0x20 && byte != 0x7f)) << shown;
            ASSERT_FALSE(byte == 0xc2 && static_cast<unsigned char>(shown[k + 1]) < 0xa0) << shown;
        }
        ASSERT_EQ(printable_lines(shown), shown);
    }
}

TEST(Text, ForAShellIsReadBackByIt) {
    EXPECT_EQ(shell_word("experiments/gallery.toml"), "experiments/gallery.toml");
    for (const std::string word :
        {"my tiny; echo pwned.toml", "it's", "$(id)", "`id`", "", "-n", "a\\b", "a\nb", "n=[4,16]", "*"}) {
        FILE* shell = popen(("printf %s. " + shell_word(word)).c_str(), "r");
        std::string back(4096, '\0');
        back.resize(fread(back.data(), 1, back.size(), shell));
        pclose(shell);
        EXPECT_EQ(back, word + ".");
    }
}

TEST(Text, IsCutBetweenCharacters) {
    EXPECT_EQ(printable("\xc3\xa9\xc3\xa9", 3), "\xc3\xa9...");
    EXPECT_EQ(printable("\xc3\xa9\xc3\xa9", 4), "\xc3\xa9\xc3\xa9");
}

TEST(Hints, SuggestOnlyWordsAFewLettersAway) {
    EXPECT_EQ(nearest("spere", {"theme", "sphere"}), "sphere");
    EXPECT_EQ(nearest("rsme", {"rmse", "var"}), "rmse");
    EXPECT_EQ(nearest("sphere", {"theme", "title"}), "");
    EXPECT_EQ(nearest("s", {"n", "title"}), "");
}

TEST(Hints, ListTheExpectedWordsAndTheNearest) {
    EXPECT_EQ(expected_one_of({"egl", "osmesa"}, "elg"), "expected one of egl, osmesa, not 'elg'; did you mean 'egl'?");
    EXPECT_EQ(expected_one_of({"cpu", "gl"}, "a\x1b"), "expected one of cpu, gl, not 'a\\x1b'");
    EXPECT_EQ(did_you_mean("egl", {"egl"}), "") << "it is that word";
    EXPECT_EQ(did_you_mean(std::string(65, 'e'), {std::string(64, 'e')}), "") << "a word of any length is no word";
}

}  // namespace text_test
}  // namespace crescent
