#include "base/text.h"

#include <gtest/gtest.h>

namespace crescent {
namespace {

TEST(Text, NothingThatMovesACursorIsPrinted) {
    EXPECT_EQ(printable("a\x1b[31mb\a\n\x7f"), "a\\x1b[31mb\\x07\\x0a\\x7f");
    EXPECT_EQ(printable("\xc2\x9b" "31m"), "\\u{9b}31m");              // CSI of one character
    EXPECT_EQ(printable("\xe2\x80\xae" "abc"), "\\u{202e}abc");        // right to left
    EXPECT_EQ(printable("na\xefve \xc3\xa9\xe2\x82\xac"), "na\\xefve \xc3\xa9\xe2\x82\xac");
}

TEST(Text, IsCutBetweenCharacters) {
    EXPECT_EQ(printable("\xc3\xa9\xc3\xa9", 3), "\xc3\xa9...");
    EXPECT_EQ(printable("\xc3\xa9\xc3\xa9", 4), "\xc3\xa9\xc3\xa9");
}

}  // namespace
}  // namespace crescent
