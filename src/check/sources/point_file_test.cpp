// Draws of points in files: right ones, wrong ones, and rows that are no points.
#include "check/sources/point_file.h"

#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

#include "check/sources/density_grid.h"
#include "check/user.h"

namespace crescent {

namespace {
namespace point_file_test {

using testing::HasSubstr;

std::string write_file(const std::string& name, const std::string& text) {
    const std::string path = testing::TempDir() + "point_file_" + name;
    std::ofstream(path) << text;
    return path;
}

/// Uniform numbers in [0, 1).
class Dice {
public:
    explicit Dice(std::uint64_t seed) : random_(seed) {}
    double operator()() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

private:
    std::mt19937_64 random_;
};

CheckResult check_file(const std::string& domain, const std::string& samples, const std::string& table) {
    ProgressMonitor monitor;
    const CheckCase check_case = make_user_case(read_point_file(*Domain::read(domain), samples, table), 0, 0);
    return run_checks({&check_case, 1}, TestSettings::quick(), monitor);
}

std::string error_of(const std::string& domain, const std::string& samples, const std::string& table) {
    try {
        read_point_file(*Domain::read(domain), samples, table);
    } catch (const InputError& e) { return e.what(); }
    return "nothing";
}

State state_of(const CheckResult& result, const std::string& verdict) {
    for (const Verdict& v : result.verdicts)
        if (v.name == verdict) return v.state;
    return State::skipped;
}

/// Draws of the unit disk with a uniform density; `power` of u gives the radius.
std::string draws_of_disk(const std::string& name, double power) {
    Dice dice(3);
    std::string text = "u1,u2,x1,x2,pdf\n";
    for (int i = 0; i < 40000; ++i) {
        const double u = dice(), v = dice(), r = std::pow(u, power);
        text += fmt::format(
            "{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", u, v, r * std::cos(2 * pi * v), r * std::sin(2 * pi * v), 1 / pi);
    }
    return write_file(name, text);
}

/// Draws of an exponential distribution, with p at points from 0 to 8.
std::pair<std::string, std::string> draws_of_line(double rate_of_draws, double rate) {
    Dice dice(4);
    std::string draws = "x1,pdf\n", table = "pdf,x1\n";
    for (int i = 0; i < 40000; ++i) {
        const double x = -std::log1p(-dice()) / rate_of_draws;
        draws += fmt::format("{:.9g},{:.9g}\n", x, rate * std::exp(-rate * x));
    }
    for (int i = 0; i <= 800; ++i) table += fmt::format("{:.9g},{:.9g}\n", rate * std::exp(-rate * i / 100), i / 100.0);
    return {write_file("line.csv", draws), write_file("line_table.csv", table)};
}

TEST(PointFiles, DiskWithoutASquareRootIsFound) {
    const std::string table = write_file("disk_table.csv", fmt::format("x1,x2,pdf\n0,0,{0:.9g}\n", 1 / pi));
    EXPECT_EQ(check_file("disk", draws_of_disk("disk.csv", 0.5), table).state, State::right);
    EXPECT_EQ(state_of(check_file("disk", draws_of_disk("root.csv", 1), table), "density"), State::wrong);
}

/// A table of the square around the unit disk or the triangle: p(x1, x2) at the centres of n x n cells, `beyond` where
/// the centre is outside.
template <class Density>
std::string table_with_boundary(const std::string& name, bool disk, int n, const char* beyond, Density p) {
    std::string text = "x1,x2,pdf\n";
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const double from = disk ? -1 : 0, step = (1 - from) / n;
            const double x = from + (i + 0.5) * step, y = from + (k + 0.5) * step;
            const bool inside = disk ? x * x + y * y < 1 : x + y < 1;
            text += fmt::format("{:.9g},{:.9g},{}\n", x, y, inside ? fmt::format("{:.9g}", p(x, y)) : beyond);
        }
    return write_file(name, text);
}

TEST(PointFiles, CellsThatTheRimCutsCountByThePartInside) {
    const std::string draws = draws_of_disk("rim.csv", 0.5), root = draws_of_disk("rim_root.csv", 1);
    const auto uniform = [](double, double) { return 1 / pi; };
    for (int n : {8, 31, 64})
        for (const char* beyond : {"0", "nan"}) {
            SCOPED_TRACE(fmt::format("{} cells, {} beyond the rim", n, beyond));
            const std::string table = table_with_boundary("rim_table.csv", true, n, beyond, uniform);
            EXPECT_EQ(check_file("disk", draws, table).state, State::right);
            EXPECT_EQ(state_of(check_file("disk", root, table), "density"), State::wrong);
        }
    const std::string low = table_with_boundary("rim_low.csv", true, 64, "0", [](double, double) { return 0.99 / pi; });
    EXPECT_EQ(state_of(check_file("disk", draws, low), "normalised"), State::wrong);
}

TEST(PointFiles, AveragesOverCellsThatTheRimCutsAreRead) {
    constexpr int n = 16, parts = 400;  // p is the mass of a cell over its whole area, as of a histogram
    std::string text = "x1,x2,pdf\n";
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            double inside = 0;
            for (int a = 0; a < parts; ++a) {
                const double x = -1 + (i + (a + 0.5) / parts) * 2 / n, top = std::sqrt(1 - x * x);
                inside += std::max(0.0, std::min(top, -1 + (k + 1) * 2.0 / n) - std::max(-top, -1 + k * 2.0 / n));
            }
            text += fmt::format(
                "{},{},{:.9g}\n", -1 + (i + 0.5) * 2 / n, -1 + (k + 0.5) * 2 / n, inside / parts * n / 2 / pi);
        }
    const std::string table = write_file("histogram.csv", text);
    EXPECT_EQ(check_file("disk", draws_of_disk("histogram_draws.csv", 0.5), table).state, State::right);
    EXPECT_EQ(state_of(check_file("disk", draws_of_disk("histogram_root.csv", 1), table), "density"), State::wrong);
}

TEST(PointFiles, CellsThatTheTriangleCutsCountByThePartInside) {
    Dice dice(5);
    std::string uniform = "x1,x2,pdf\n", linear = uniform, missing_root = uniform;
    for (int i = 0; i < 40000; ++i) {
        const double u = dice(), v = dice(), rest = std::sqrt(u);
        uniform += fmt::format("{:.9g},{:.9g},2\n", 1 - rest, v * rest);
        missing_root += fmt::format("{:.9g},{:.9g},2\n", 1 - u, v * u);
        const double b = 1 - std::cbrt(u);  // p = 6 (1 - b0 - b1): the least of three exponential shares
        const double c = (1 - b) * (1 - std::sqrt(v));
        linear += fmt::format("{:.9g},{:.9g},{:.9g}\n", b, c, 6 * (1 - b - c));
    }
    const auto constant = [](double, double) { return 2.0; };
    for (int n : {9, 32}) {
        SCOPED_TRACE(fmt::format("{} cells", n));
        const std::string table = table_with_boundary("triangle_table.csv", false, n, "0", constant);
        EXPECT_EQ(check_file("triangle", write_file("triangle.csv", uniform), table).state, State::right);
        EXPECT_EQ(
            state_of(check_file("triangle", write_file("root.csv", missing_root), table), "density"), State::wrong);
    }
    const std::string table =
        table_with_boundary("linear_table.csv", false, 64, "0", [](double x, double y) { return 6 * (1 - x - y); });
    EXPECT_EQ(check_file("triangle", write_file("linear.csv", linear), table).state, State::right);
    EXPECT_EQ(state_of(check_file("triangle", write_file("linear.csv", linear),
                           table_with_boundary("constant.csv", false, 64, "0", constant)),
                  "density"),
        State::wrong);
}

TEST(PointFiles, TableOfAPartOfTheDomainIsRefused) {
    std::string line = "x1,pdf\n", square = "x1,x2,pdf\n";
    for (int i = 0; i < 4000; ++i) {
        line += fmt::format("{},1\n", (i + 0.5) / 4000);
        square += fmt::format("{},{},1\n", (i + 0.5) / 4000, (i % 63) / 63.0);
    }
    const std::string draws = write_file("finite.csv", line);
    const auto error_at = [&](const char* rows) {
        return error_of("line:0,1", draws, write_file("part.csv", std::string("x1,pdf\n") + rows));
    };
    EXPECT_THAT(error_at("0.05,1\n0.25,1\n0.45,1\n"),
        HasSubstr("part.csv:4:1: the entries of x1 are from 0.05 to 0.45; expected a table over all of [0, 1]"));
    EXPECT_THAT(error_at("0.5,1\n0.75,1\n1,1\n"), HasSubstr("part.csv:2:1"));
    EXPECT_EQ(error_at("0.1,1\n0.3,1\n0.5,1\n0.7,1\n0.9,1\n"), "nothing");
    EXPECT_EQ(error_at("0,1\n0.5,1\n1,1\n"), "nothing");
    EXPECT_EQ(error_at("0.4,1\n"), "nothing");
    EXPECT_THAT(error_of("square", write_file("square.csv", square),
                    write_file("half_square.csv", "x1,x2,pdf\n0,0,1\n0,0.25,1\n1,0,1\n1,0.25,1\n")),
        HasSubstr("the entries of x2 are from 0 to 0.25; expected a table over all of [0, 1]"));
    EXPECT_THAT(error_of("line:0,inf", draws, write_file("late.csv", "x1,pdf\n0.5,1\n0.6,1\n1,1\n")),
        HasSubstr("p below 0.5 is not known"));
}

TEST(PointFiles, InfiniteLineIsTestedWithinItsTable) {
    const auto [draws, table] = draws_of_line(2, 2);
    EXPECT_EQ(check_file("line:0,inf", draws, table).state, State::right);
    const auto [other, its_table] = draws_of_line(2, 2.2);
    const CheckResult wrong = check_file("line:0,inf", other, its_table);
    EXPECT_EQ(state_of(wrong, "density"), State::wrong);
    EXPECT_EQ(state_of(wrong, "identity"), State::right);
    const std::string shorter = write_file("shorter.csv", "x1,pdf\n0,2\n1,0.2\n");
    EXPECT_THAT(error_of("line:0,inf", draws, shorter), HasSubstr("is outside the table of the density"));
}

TEST(PointFiles, RowsThatAreNoPointsAreNamed) {
    std::string draws = "x1,pdf\n", bad;
    for (int i = 0; i < 4000; ++i) draws += fmt::format("{},0.25\n", i % 4);
    const std::string table = write_file("set_table.csv", "x1,pdf\n0,0.25\n1,0.25\n2,0.25\n3,0.25\n");
    const CheckResult j = check_file("set:4", write_file("half.csv", draws + "1.5,0.25\n"), table);
    ASSERT_EQ(state_of(j, "valid"), State::wrong);
    EXPECT_THAT(j.verdicts[0].message(), HasSubstr("half.csv:4002: entry 1.5, which is not an integer"));
    EXPECT_THAT(error_of("set:4", write_file("text.csv", draws + "one,0.25\n"), table),
        HasSubstr("text.csv:4002:1: expected a number, not 'one'"));
    EXPECT_THAT(error_of("set:4", write_file("header.csv", "i,pdf\n1,1\n"), table),
        HasSubstr("expected the header x1,pdf or u1,u2,x1,pdf"));
    EXPECT_THAT(
        error_of("set:5", write_file("whole.csv", draws), table), HasSubstr("expected all 5 values of x1, not 4"));
}

TEST(DensityGrid, IsConstantInCellsOrLinearBetweenPoints) {
    const DensityGrid grid({{.name = "x1"}, {.name = "x2"}},
        std::vector<double>{0.25, 0.5, 1, 0.75, 0.5, 3});  // two cells along x1, one along x2
    const auto at = [](double x) { return std::array{x, 0.9}; };
    EXPECT_EQ(grid.cell_value(at(0.4)), 1);
    EXPECT_EQ(grid.cell_value(at(0.6)), 3);
    EXPECT_DOUBLE_EQ(grid.value_between(at(0.5)), 2);
    EXPECT_DOUBLE_EQ(grid.value_between(at(0)), 0);
    EXPECT_FALSE(grid.contains(at(1.1)));
    EXPECT_THROW(DensityGrid({{.name = "x1"}}, std::vector<double>{0, 1, 0, 1}), std::invalid_argument);
}

TEST(DensityGrid, PeriodicAxisHasNoEnds) {
    const DensityGrid grid({{.name = "phi", .to = 4, .is_periodic = true}}, std::vector<double>{1, 5, 3, 1});
    EXPECT_DOUBLE_EQ(grid.value_between(std::array{0.0}), 3);
    EXPECT_DOUBLE_EQ(grid.value_between(std::array{4.0}), 3);
    EXPECT_DOUBLE_EQ(grid.error_between(std::array{1.0}), 4);
}

}  // namespace point_file_test
}  // namespace

}  // namespace crescent
