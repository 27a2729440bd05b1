// Charts of domains: their measure, points and directions there and back, words, and what is refused.
#include "samplers/domains/domain_chart.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

#include "check/estimate/stream.h"

namespace crescent::check {

namespace {
namespace domain_chart_test {

struct Case {
    const char* name;
    std::vector<double> inside, outside;
    double measure;
};
const Case domain_cases[] = {{"disk", {0.3, -0.4}, {0.8, 0.8}, pi}, {"square", {0.2, 0.9}, {0.2, 1.1}, 1},
    {"cube", {0.2, 0.9, 0.5}, {0.2, 0.9, -0.5}, 1}, {"triangle", {0.2, 0.3}, {0.7, 0.7}, 0.5},
    {"line:2,5", {2.5}, {5.5}, 3}, {"set:37", {17}, {17.5}, 37},
    {"set:3 x hemisphere", {2, 0, 0.6, 0.8}, {3, 0, 0, 1}, 6 * pi},
    {"sphere x square", {0, 0.6, -0.8, 0.1, 0.7}, {0, 0.6, 0.6, 0.1, 0.7}, 4 * pi}};

std::vector<double> some_numbers(Stream& stream, std::size_t count) {
    std::vector<double> out(count);
    for (double& v : out) v = stream.number();
    return out;
}

DomainChart chart_of(const std::string& name) { return DomainChart(*Domain::read(name)); }

TEST(DomainChart, IsThereAndBackTheSamePoint) {
    Stream stream({.seed = 3});
    for (const Case& c : domain_cases) {
        const DomainChart chart = chart_of(c.name);
        for (int i = 0; i < 100; ++i) {
            const std::vector<double> spread = some_numbers(stream, chart.spreads());
            const Vec3d w = chart.direction(c.inside, spread);
            EXPECT_NEAR(length(w), 1, 1e-12);
            std::vector<double> back(c.inside.size());
            EXPECT_GT(chart.point(w, back), 0);
            for (std::size_t k = 0; k < back.size(); ++k) EXPECT_NEAR(back[k], c.inside[k], 1e-6) << c.name;
        }
        EXPECT_EQ(chart.domain().fault(c.inside), "") << c.name;
        EXPECT_NE(chart.domain().fault(c.outside), "") << c.name;
    }
}

/// The mean of the factor over the sphere, times 4 pi, is the measure of the domain.
TEST(DomainChart, FactorIntegratesToTheMeasure) {
    for (const Case& c : domain_cases) {
        const DomainChart chart = chart_of(c.name);
        Stream stream({.seed = 5});
        std::vector<double> x(c.inside.size());
        double sum = 0;
        constexpr int n = 20000;
        for (int i = 0; i < n; ++i) sum += chart.point(from_chart({2 * stream.number(), two_pi * stream.number()}), x);
        EXPECT_NEAR(4 * pi * sum / n, c.measure, 0.03 * c.measure) << c.name;
    }
}

/// Infinite lines have the quantiles of the points that they were fitted to: equal masses are equal solid angles.
TEST(DomainChart, FitsInfiniteLines) {
    for (const char* name : {"line:0,inf", "line:-inf,inf", "line:-inf,0"}) {
        DomainChart chart = chart_of(name);
        Stream stream({.seed = 7});
        std::vector<double> points;
        for (int i = 0; i < 4096; ++i) {
            const double u = stream.number(), e = -1e-4 * std::log(u);
            points.push_back(std::string(name) == "line:0,inf" ? e
                    : std::string(name) == "line:-inf,0"       ? -e
                                                               : std::tan(pi * (u - 0.5)));
        }
        chart.fit(points);
        double below = 0;
        for (double x : points) {
            const double half = 0.5;
            const Vec3d w = chart.direction({&x, 1}, {&half, 1});
            below += w.z > 0;
            double back = 0;
            EXPECT_GT(chart.point(w, {&back, 1}), 0);
            EXPECT_NEAR(back, x, 1e-6 * std::fabs(x) + 1e-12) << name;
        }
        EXPECT_NEAR(below / 4096, 0.5, 0.01) << name;
    }
}

/// A narrow distribution, and points of a wide one that the chart was fitted to no draws of.
TEST(DomainChart, LinesGoOnFarBeyondTheDraws) {
    DomainChart chart = chart_of("line:-inf,inf");
    Stream stream({.seed = 8});
    std::vector<double> points;
    for (int i = 0; i < 4096; ++i) points.push_back(0.05 * (stream.number() + stream.number() - 1));
    chart.fit(points);
    for (double x : {-1e5, -7.0, -0.06, 0.5, 3.0, 1e4}) {
        const double half = 0.5;
        double back = 0;
        EXPECT_GT(chart.point(chart.direction({&x, 1}, {&half, 1}), {&back, 1}), 0);
        EXPECT_NEAR(back, x, 1e-3 * std::fabs(x));
    }
}

TEST(DomainChart, NamesPlaces) {
    const DomainChart set = chart_of("set:37");
    EXPECT_EQ(set.text(set.direction(std::array{17.0}, std::array{0.5, 0.5})), "entry 17");
    const double cell = 2.0 / 64;
    EXPECT_EQ(set.text(ChartRect{16 * cell, 24 * cell, 0, two_pi}), "at entries 16 to 23");
    EXPECT_EQ(set.entry({17 * cell, 18 * cell, 0, two_pi}), 17u);
    EXPECT_EQ(set.entry({16 * cell, 18 * cell, 0, two_pi}), std::nullopt);
    const DomainChart line = chart_of("line:380,780");
    EXPECT_EQ(line.text(ChartRect{0, 1, 0, two_pi}), "at x from 380 to 580");
    EXPECT_EQ(line.text(ChartRect{}), "everywhere");
    const DomainChart disk = chart_of("disk");
    EXPECT_EQ(disk.text(ChartRect{0, 0.5, 0, two_pi / 2}), "at radius from 0 to 0.5, angle from 0 to 180 deg");
    // The first bits of polar and azimuthal coordinates are those of x, y, z, x, ... in turn.
    const DomainChart cube = chart_of("cube");
    EXPECT_EQ(cube.text(ChartRect{0, 1, 0, two_pi / 2}), "at x from 0 to 0.5, y from 0 to 0.5");
}

TEST(Domain, ReadsNames) {
    EXPECT_EQ(Domain::read("sphere x line:0,inf")->dimensions(), 3u);
    EXPECT_EQ(Domain::read("spherexline:0,inf")->name(), "sphere x line:0,inf");
    EXPECT_TRUE(Domain::read("hemisphere")->is_direction());
    for (const char* wrong : {"", "ball", "line", "line:1,1", "line:2,1", "line:0", "line:a,b", "set:0", "set:1000001",
             "set:1.5", "set", "disk:2", "cube x disk", "disk x", "x disk", "line:nan,1"})
        EXPECT_FALSE(Domain::read(wrong)) << wrong;
}

}  // namespace domain_chart_test
}  // namespace

}  // namespace crescent::check
