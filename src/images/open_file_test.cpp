// Files that are read by offset, their text headers, and rectangles of pixels.
#include "images/open_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/support/scratch_folder.h"

namespace crescent {
namespace open_file_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using OpenFiles = ScratchFolder;

TEST(PixelWindows, IntersectInTheirCommonPixels) {
    const PixelWindow a{0, 0, 9, 9}, b{5, -3, 20, 4};
    EXPECT_EQ(intersection(a, b), (PixelWindow{5, 0, 9, 4}));
    EXPECT_EQ(intersection(a, b).pixels(), 25u);
    EXPECT_TRUE(intersection(a, {10, 0, 12, 9}).empty());
    EXPECT_FALSE(intersection(a, {9, 9, 12, 12}).empty());
}

TEST_F(OpenFiles, ReadsBeyondTheEndAreRefused) {
    const OpenFile file(write("f", "0123456789"));
    EXPECT_EQ(file.size(), 10u);
    std::array<char, 4> bytes{};
    file.read(6, bytes);
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "6789");
    EXPECT_EQ(file.read_some(8, bytes), 2u);
    EXPECT_EQ(file.read_some(20, bytes), 0u);
    EXPECT_THROW(file.read(7, bytes), InputError);
    EXPECT_EQ(refusal([&] { return file.expect_bytes(6, 4, "it"), 0; }), "");
    EXPECT_NE(refusal([&] { return file.expect_bytes(6, 5, "it"), 0; }), "");
    EXPECT_NE(refusal([&] { return file.expect_bytes(20, 1, "it"), 0; }), "");
}

TEST_F(OpenFiles, AFileThatGrowsIsNoticed) {
    const std::string name = write("f", "0123");
    const OpenFile file(name);
    EXPECT_NO_THROW(file.expect_unchanged());
    write("f", "01234");
    EXPECT_THROW(file.expect_unchanged(), InputError);
}

TEST_F(OpenFiles, HeadersHaveNumberedLines) {
    const OpenFile file(write("f", "one\r\ntwo\nrest"));
    TextHeader header(file);
    EXPECT_EQ(split_words(header.line()).at(0).substr(0, 3), "one");
    EXPECT_EQ(header.line(), "two");
    EXPECT_EQ(header.end(), 9u);
    EXPECT_THAT(refusal([&] { return header.check_size(0, 4), 0; }), HasSubstr("f:2:1: "));
    EXPECT_EQ(refusal([&] { return header.check_size(65536, 65536), 0; }), "");
    EXPECT_NE(refusal([&] { return header.check_size(65537, 1), 0; }), "");
    EXPECT_THROW((void)header.line(), InputError);  // it does not end
    const OpenFile endless(write("g", std::string(5000, 'x') + "\n"));
    EXPECT_THROW((void)TextHeader(endless).line(), InputError);
}

TEST(HeaderText, IsSplitAndParsedAsAWhole) {
    EXPECT_THAT(split_words("  a  bc\td "), ElementsAre("a", "bc", "d"));
    EXPECT_THAT(split_words(""), ElementsAre());
    double x = 0;
    int n = 0;
    EXPECT_TRUE(parse_number("-1.5e2", x));
    EXPECT_EQ(x, -150);
    for (const char* bad : {"", "1x", " 1", "1.5"}) EXPECT_FALSE(parse_number(bad, n)) << bad;
}

}  // namespace open_file_test
}  // namespace crescent
