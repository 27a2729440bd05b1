// Files as spreadsheets and NPY writers produce them, and invalid ones, each of which is rejected with its place.
#include <cmath>
#include <cstring>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "check/sources/sample_file.h"

namespace crescent {
namespace sample_file_test {

using testing::ElementsAre;
using testing::HasSubstr;

std::string file_of(const std::string& name, const std::string& bytes) {
    const std::string path = testing::TempDir() + "table_file_" + name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}

NumberTable read(const std::string& path) {
    FileDiagnostics in{path, {}};
    NumberTable t = read_table_file(in, {{"a", "b"}, {"a", "b", "c"}});
    in.throw_if_any();
    return t;
}

/// The message for a file that cannot be read.
std::string error_of(const std::string& path) {
    try {
        read(path);
    } catch (const InputError& e) { return e.what(); }
    return "nothing";
}

/// An array in the format of NumPy, with this text in place of its header's dictionary.
std::string npy(const std::string& dictionary, const std::string& numbers) {
    const auto length = static_cast<std::uint16_t>(dictionary.size());
    return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(length & 255) + static_cast<char>(length >> 8) +
        dictionary + numbers;
}
template <class F> std::string bytes_of(std::initializer_list<F> numbers) {
    std::string out(sizeof(F) * numbers.size(), '\0');
    std::memcpy(out.data(), std::data(numbers), out.size());
    return out;
}

TEST(TableFiles, ColumnsAreReadByName) {
    const NumberTable t = read(file_of("t.csv",
        "\xef\xbb\xbf"
        "c, b,a\r\n1,2,+3e-1\n\n-4,inf,nan\n"));
    ASSERT_EQ(t.rows(), 2u);
    EXPECT_EQ(t.at(0, 0), 1);
    EXPECT_EQ(t.at(0, static_cast<std::size_t>(t.column("a"))), 0.3);
    EXPECT_TRUE(std::isinf(t.at(1, static_cast<std::size_t>(t.column("b")))));
    EXPECT_TRUE(std::isnan(t.at(1, static_cast<std::size_t>(t.column("a")))));
    EXPECT_THAT(t.lines, ElementsAre(2u, 4u));
    EXPECT_EQ(t.column("d"), -1);
}

TEST(TableFiles, NpyFilesAreEqualInEitherOrderAndPrecision) {
    const std::string rows = "'fortran_order': False, 'shape': (3, 2), }",
                      columns = "'fortran_order': True, 'shape': (3, 2), }";
    const auto values = ElementsAre(1, 2, 3, 4, 5, 6);
    EXPECT_THAT(
        read(file_of("r.npy", npy("{'descr': '<f8', " + rows, bytes_of<double>({1, 2, 3, 4, 5, 6})))).values, values);
    EXPECT_THAT(
        read(file_of("c.npy", npy("{'descr': '<f4', " + columns, bytes_of<float>({1, 3, 5, 2, 4, 6})))).values, values);
}

// A density must not be infinite, so a number too large for a double is rejected; as 0 it would be accepted.
TEST(TableFiles, OverflowIsInfiniteAndUnderflowIsZero) {
    const NumberTable t = read(file_of("o.csv", "a,b\n1e999,-1e999\n1e-999,-1e-999\n"));
    EXPECT_EQ(t.at(0, 0), INFINITY);
    EXPECT_EQ(t.at(0, 1), -INFINITY);
    EXPECT_EQ(t.at(1, 0), 0);
    EXPECT_EQ(t.at(1, 1), 0);
}

TEST(TableFiles, NameEveryMistakeWithItsPlace) {
    const std::string message = error_of(file_of("m.csv", "a,b\n1,two\n3\n"));
    EXPECT_THAT(message, HasSubstr("m.csv:2:3: expected a number, not 'two'"));
    EXPECT_THAT(message, HasSubstr("m.csv:3:1: expected 2 values, as the header has, not 1"));
    EXPECT_THAT(error_of(file_of("h.csv", "a,z\n1,2\n")), HasSubstr("expected the header a,b or a,b,c, not a,z"));
    EXPECT_THAT(error_of(file_of("e.csv", "")), HasSubstr("is empty"));
    EXPECT_THAT(error_of(testing::TempDir() + "absent.csv"), HasSubstr("cannot be read"));
}

TEST(TableFiles, InvalidNpyFilesAreRejected) {
    const std::string numbers = bytes_of<double>({1, 2});
    const std::string order = "'fortran_order': False, ";
    for (const auto& [dictionary, message] :
        {std::pair<std::string, std::string>{"{" + order + "'descr': '<i8', 'shape': (1, 2)}", "<f4"},
            {"{" + order + "'descr': '<f8', 'shape': (2,)}", "two-dimensional"},
            {"{" + order + "'descr': '<f8', 'shape': (1, 7)}", "columns, not 7"},
            {"{" + order + "'descr': '<f8', 'shape': (2, 2)}", "ends in row 2 of 2"},
            {"{" + order + "'descr': '<f8', 'shape': (9999999999999999999, 2)}",
                "ends in row 2 of 9999999999999999999"},
            {"{" + order + "'descr': '<f8', 'shape': (99999999999999999999, 2)}", "'shape'"},
            {"{'descr': '<f8', 'shape': (1, 2)}", "'fortran_order'"}, {"", "'descr'"}})
        EXPECT_THAT(error_of(file_of("b.npy", npy(dictionary, numbers))), HasSubstr(message)) << dictionary;
    EXPECT_THAT(error_of(file_of("s.npy", "\x93NUM")), HasSubstr("expected an NPY file"));
}

// Gaps as long as the header allows, which a regular expression that recurses for each character would not survive.
TEST(TableFiles, NpyHeadersMayHaveLongGaps) {
    const std::string gap(20000, ' ');
    const std::string dictionary = "{'descr':" + gap + "'<f8', 'fortran_order': False, 'shape':" + gap + "(1, 2), }";
    EXPECT_THAT(read(file_of("g.npy", npy(dictionary, bytes_of<double>({7, 8})))).values, ElementsAre(7, 8));
}

TEST(TableFiles, DensityOfAPartOfTheDirectionsIsRefused) {
    std::string draws = "u1,u2,wix,wiy,wiz,pdf\n";
    for (int i = 0; i < 1000; ++i) draws += "0.5,0.5,0,0,1,0.15915494\n";
    const std::string samples = file_of("draws.csv", draws);
    const auto refusal = [&](const char* rows) -> std::string {
        try {
            const SampleFile read(samples, file_of("part.csv", std::string("cos_theta,phi,pdf\n") + rows));
        } catch (const InputError& e) { return e.what(); }
        return "nothing";
    };
    EXPECT_EQ(refusal("0.25,1,1\n0.25,4,1\n0.75,1,1\n0.75,4,1\n"), "nothing");
    EXPECT_THAT(refusal("0.7,1,1\n0.7,4,1\n0.9,1,1\n0.9,4,1\n"),
        HasSubstr("part.csv:2:1: the entries of cos_theta are from 0.7 to 0.9; expected a table over all of [0, 1]"));
    EXPECT_THAT(refusal("0.25,0,1\n0.25,1,1\n0.75,0,1\n0.75,1,1\n"),
        HasSubstr(
            "the entries of phi are from 0 to 1; expected a table over all of [0, 6.28319]: p between 1 and 6.28319 "
            "is not known"));
}

}  // namespace sample_file_test
}  // namespace crescent
