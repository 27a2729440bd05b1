// Cubature against integrals that are known in closed form: the stated error holds, and the audit is another estimate
// of the same.
#include <cmath>
#include <gtest/gtest.h>

#include "cubature/cell.h"
#include "simd/scalar.h"

namespace crescent::inline cubature {
namespace {

struct Known {
    std::string name;
    std::function<double(double a, double b)> g;  // over the unit square
    double integral;
    double within = 1e-4;  // what the cubature is asked to reach, and does
};

double in_disc(double a, double b, double x, double y, double r) { return sqr(a - x) + sqr(b - y) < r * r ? 1 : 0; }

std::vector<Known> known_integrals() {
    const auto gauss = [](double a, double b, double x, double y, double w) {
        return std::exp(-(sqr(a - x) + sqr(b - y)) / (w * w)) / (pi * w * w);
    };
    return {
        {"a constant", [](double, double) { return 3.0; }, 3, 1e-12},
        {"a polynomial of degree 7",
            [](double a, double b) { return std::pow(a, 3) * std::pow(b, 4) + std::pow(a, 7); }, 1 / 20.0 + 1 / 8.0,
            1e-6},
        {"a wide Gaussian", [=](double a, double b) { return gauss(a, b, 0.5, 0.5, 0.1); }, sqr(std::erf(5.0)), 1e-5},
        {"a narrow Gaussian off centre", [=](double a, double b) { return gauss(a, b, 0.371, 0.642, 0.01); }, 1, 1e-5},
        {"a ridge", [](double a, double b) { return std::exp(-sqr((a - b) / 0.01)) / (0.01 * std::sqrt(pi)); },
            1 - 0.01 / std::sqrt(pi), 1e-5},
        {"a disc", [](double a, double b) { return in_disc(a, b, 0.47, 0.53, 0.31); }, pi * sqr(0.31)},
        {"a faint disc on a floor", [](double a, double b) { return 1 + 0.1 * in_disc(a, b, 0.61, 0.33, 0.2); },
            1 + 0.1 * pi * 0.04},
        {"a half plane", [](double a, double b) { return a + 0.3 * b < 0.6 ? 1.0 : 0.0; }, 0.45},
        {"a smooth slope up to a jump", [](double a, double b) { return a < 0.7 - 0.2 * b ? a : 0.0; },
            (std::pow(0.7, 3) - std::pow(0.5, 3)) / 1.2},
        {"a corner cut off", [](double a, double b) { return a + b < 0.04 ? 100.0 : 1.0; }, 1 + 99 * 0.5 * sqr(0.04)},
        {"a rectangle askew",
            [](double a, double b) {
                const double c = std::cos(0.4), s = std::sin(0.4), x = a - 0.52, y = b - 0.47;
                return std::fabs(c * x + s * y) < 0.21 && std::fabs(c * y - s * x) < 0.13 ? 4.0 : 0.0;
            },
            4 * 4 * 0.21 * 0.13, 2e-5},
        {"a disc with a pole at its rim",
            [](double a, double b) {
                const double left = sqr(0.31) - sqr(a - 0.47) - sqr(b - 0.53);
                return left > 0 ? 1 / std::sqrt(left) : 0.0;
            },
            2 * pi * 0.31, 2e-3},
        {"a chequer of steps", [](double a, double b) { return 1 + (int(a * 7) + int(b * 5)) % 3; }, 69 / 35.0},
        {"a pole at a corner", [](double a, double b) { return 1 / std::sqrt(a * a + b * b + 1e-300); },
            2 * std::log(1 + std::sqrt(2.0)), 1e-4},
    };
}

Batch batch_of(const std::function<double(double, double)>& g) {
    return [g](std::span<const Vec2d> at, std::span<double> out) {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = g(at[i].x, at[i].y);
    };
}

std::vector<Rect> grid(int n) {
    std::vector<Rect> out;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k)
            out.push_back({double(i) / n, double(i + 1) / n, double(k) / n, double(k + 1) / n, 0});
    return out;
}

TEST(Cubature, MeetsKnownIntegralsWithinItsStatedError) {
    for (const Known& k : known_integrals()) {
        const Integral found = integrate(grid(4), 1, batch_of(k.g), {5e-6, 400000, 1e-4});
        EXPECT_LE(std::fabs(found.value - k.integral), found.error + 1e-12 * k.integral)
            << k.name << ": " << found.value << ", not " << k.integral;
        EXPECT_LE(std::fabs(found.value - k.integral), k.within) << k.name;
        EXPECT_LE(found.error, 20 * k.within) << k.name << ": a stated error says something";
        EXPECT_LE(std::fabs(found.second - k.integral), 5 * found.second_se + 1e-12 * k.integral)
            << k.name << ": the audit";
    }
}

TEST(Cubature, StatesAnErrorThatHoldsWhereItsEffortEnds) {
    for (const Known& k : known_integrals())
        for (std::size_t most : {1000, 4000, 16000}) {
            const Integral found = integrate(grid(4), 1, batch_of(k.g), {5e-6, most, 1e-4});
            EXPECT_LE(std::fabs(found.value - k.integral),
                std::max(2 * found.error, 5 * found.second_se) + 1e-12 * k.integral)
                << k.name << " after " << found.evaluations << ": " << found.value << ", not " << k.integral;
        }
}

TEST(Cubature, KnowsEveryBinAndAddsThemUp) {
    std::vector<Rect> cells = grid(4);
    for (std::size_t i = 0; i < cells.size(); ++i) cells[i].bin = static_cast<int>(i / 4);  // strips of a
    const auto g = [](double a, double b) { return a + 0.3 * b < 0.6 ? 1.0 : 0.0; };
    const Integral found = integrate(cells, 4, batch_of(g), {5e-6, 400000, 1e-4});
    EXPECT_NEAR(found.bins[0], 0.25, 1e-9);
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const double low = 0.25 * double(i), high = low + 0.25;  // b < (0.6 - a) / 0.3, at most 1
        const double whole = std::max(std::min(high, 0.3) - low, 0.0), from = std::max(low, 0.3),
                     to = std::min(high, 0.6);
        const double slope = to > from ? (sqr(0.6 - from) - sqr(0.6 - to)) / 0.6 : 0;
        EXPECT_NEAR(found.bins[i], whole + slope, 3 * found.bin_errors[i] + 1e-9) << i;
        EXPECT_LT(found.bin_errors[i], 1e-4) << i;
        sum += found.bins[i];
    }
    EXPECT_DOUBLE_EQ(sum, found.value);
}

/// As many directions as one w_o of a program is asked about, and what a rectangle light's density looks like.
TEST(Cubature, KnowsTheEdgesOfARectangleForLittle) {
    for (double turn : {0.1, 0.5, 0.9, 1.3}) {
        const double c = std::cos(turn), s = std::sin(turn);
        const auto g = [&](double a, double b) {
            const double x = a - 0.52, y = b - 0.47, u = c * x + s * y, v = c * y - s * x;
            return std::fabs(u) < 0.21 && std::fabs(v) < 0.13 ? (1 + 2 * u) / (4 * 0.21 * 0.13) : 0.0;
        };
        const Integral found = integrate(grid(4), 1, batch_of(g), {2e-5, 80000, 4e-4});
        EXPECT_NEAR(found.value, 1, found.error) << turn;
        EXPECT_TRUE(found.settled) << turn;
        EXPECT_LT(found.error, 1e-4) << turn;
        EXPECT_LT(found.evaluations, 160000u) << turn;
    }
}

TEST(Cubature, CutsACellOnBothSidesOfAJump) {
    const auto g = [](double a, double b) { return a < 0.3 + 0.1 * b ? 2.0 : 0.5; };
    std::vector<Cell> cells = {Cell({0, 1, 0, 1, 0}, 0)};
    cells[0].error = cells[0].rule_error = 1;
    cells[0].high = 2;
    cells[0].low = 0.5;
    for (std::size_t i : {0u, 4u, 5u}) cells[0].outer[i] = 2;
    cut_along_jumps(cells, batch_of(g), 10, 1000);
    EXPECT_TRUE(cells[0].cut);
    EXPECT_NEAR(cells[0].value, 2 * 0.35 + 0.5 * 0.65, 1e-4);
}

/// The triangle in a corner: lines through it have a kink where the jump leaves the cell.
TEST(Cubature, CutsACornerOff) {
    const auto g = [](double a, double b) { return a / 0.37 + b / 0.61 < 1 ? 2.0 : 0.0; };
    std::vector<Cell> cells = {Cell({0, 1, 0, 1, 0}, 0)};
    cells[0].rule_error = 1;
    cells[0].high = 2;
    cut_along_jumps(cells, batch_of(g), 10, 1000);
    EXPECT_TRUE(cells[0].cut);
    EXPECT_EQ(cells[0].lines.pieces, 2);
    EXPECT_NEAR(cells[0].value, 0.37 * 0.61, 1e-3);
    audit(cells, 1, batch_of(g), 7, 0.01, 0);
    EXPECT_NEAR(*cells[0].second, 0.37 * 0.61, 2e-3);
    EXPECT_TRUE(cells[0].cut) << "one curve";
}

TEST(Cubature, HalvesACellAgainThatTwoJumpsCross) {
    const auto g = [](double a, double b) { return std::fabs(a - 0.5) < 0.2 + 0.1 * b ? 1.0 : 0.0; };
    std::vector<Cell> cells = {Cell({0, 1, 0, 1, 0}, 0)};
    cells[0].rule_error = 1;
    cells[0].high = 1;
    cells[0].outer[0] = 1;
    cut_along_jumps(cells, batch_of(g), 10, 1000);
    const Audit look = audit(cells, 1, batch_of(g), 7, 0.001, 0);
    EXPECT_TRUE(look.found);
    EXPECT_TRUE(cells[0].bent);
    EXPECT_FALSE(cells[0].cut);
    EXPECT_GT(cells[0].error, 0.01);
}

/// A jump through the side of a large cell, where none of its own points is: the small cells beside it tell.
TEST(Cubature, FollowsAJumpIntoTheCellBesideIt) {
    const auto g = [](double a, double b) { return a < 0.51 - 4 * sqr(b - 0.3) ? 1.0 : 0.0; };
    std::vector<Cell> cells = {Cell({0.25, 0.5, 0.2, 0.3, 0}, 0), Cell({0.5, 1, 0, 1, 0}, 0)};
    cells[0].cut = cells[0].rim_tried = true;
    cells[0].high = 1;
    cells[0].outer = {1, 1, 1, 1, 1, 1, 0, 1};
    bool found = false;
    EXPECT_GT(look_around(cells, batch_of(g), 1e-4, found), 0u);
    EXPECT_TRUE(found);
    EXPECT_TRUE(cells[1].rim_jumps);
    EXPECT_GT(cells[1].error, 0);
    EXPECT_FALSE(cells[0].looked_around) << "it asks the halves";
}

TEST(Cubature, SeesASpikeThatDrawsFell) {
    const auto g = [](double a, double b) {
        return std::exp(-(sqr(a - 0.3371) + sqr(b - 0.7113)) / sqr(2e-3)) / (pi * sqr(2e-3));
    };
    SamplesPerBin fell{{std::vector<SampleValue>(1000, SampleValue{{0.33712, 0.71127}, 0})}, 1000};
    EXPECT_NEAR(integrate(grid(4), 1, batch_of(g), {5e-6, 400000, 1e-4}, &fell).value, 1, 1e-4);
}

/// A sliver of a bright disc in the corner of a dark cell, where neither the rule nor its rim looks.
TEST(Cubature, BelievesADrawThatFellHigherThanItSaw) {
    const auto g = [](double a, double b) { return in_disc(a, b, 0.52, 0.55, 0.004) * 2000 + 0.9; };
    SamplesPerBin fell{{{}}, 1000};
    for (int i = 0; i < 100; ++i)
        fell.bins[0].push_back({{0.52 + 0.0003 * (i % 10 - 5), 0.55 + 0.0003 * (i / 10 - 5)}, 2000.9});
    const Integral found = integrate(grid(4), 1, batch_of(g), {5e-6, 400000, 1e-4}, &fell);
    EXPECT_NEAR(found.value, 0.9 + 2000 * pi * sqr(0.004), 2e-4);
}

}  // namespace
}  // namespace crescent::inline cubature
