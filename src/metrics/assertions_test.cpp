// Assertions on synthetic measurements with known answers.
#include "metrics/assertions.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "metrics/metrics.h"

namespace crescent {
namespace assertions_test {

Experiment two_arms(const std::vector<std::pair<std::string, bool>>& checks) {
    Experiment e;
    e.seed = 5;
    Shape ball;
    ball.name = "ball";
    ball.material.s = 32;
    ball.material.rho_s = 0.1;
    e.shapes = {ball};
    e.arms = {{"a", "cosine", {4, 16}, {}}, {"b", "phong", {4}, {}}};
    e.regions = {{"H", {2, 3, 5, 4}, {}}};
    for (const auto& [text, median] : checks) {
        std::string why;
        const auto c = parse_comparison(text, why);
        EXPECT_TRUE(c) << why;
        e.assertions.push_back({text, text, *c, median, {}});
    }
    return e;
}

RunMetrics run(const std::string& arm, std::uint64_t n, std::uint32_t seed, double rmse) {
    RunMetrics r;
    r.key = {arm, n, 32, seed};
    r.regions = {{.region = "H", .rmse = rmse, .var = rmse * rmse, .pixels = 8, .tail = std::nullopt}};
    r.fireflies = seed;
    return r;
}

/// Three seeds; b is worse than a at seed 5 and better on the median.
Metrics measured() {
    Metrics m;
    const double of_a[] = {2, 4, 9}, of_b[] = {3, 1, 1};
    for (std::uint32_t i = 0; i < 3; ++i)
        for (const std::uint64_t n : {4u, 16u}) {
            m.runs.push_back(run("a", n, 5 + i, of_a[i] / static_cast<double>(n)));
            m.runs.push_back(run("b", n, 5 + i, of_b[i] / static_cast<double>(n)));
        }
    m.furnaces = {{"white", "a", "combined", 64, 0.27, 0.30, 0.01, std::nullopt, 0, std::nullopt}};
    m.shape_pixels = {{"ball", 120}};
    m.geometry_pixels = 500;
    return m;
}

bool verdict(const std::string& check, bool median = false, const Metrics& m = measured()) {
    return evaluate_assertions(two_arms({{check, median}}), m, {{"hero", 1000}}).at(0).pass;
}

TEST(Quantities, AreReadFromTheRunTheyName) {
    EXPECT_TRUE(verdict("rmse.H(a, n=4) == 0.5"));
    EXPECT_TRUE(verdict("rmse.H(a, n=16) == 0.125"));
    EXPECT_TRUE(verdict("rmse.H(b) == 0.75")) << "b has one sample count";
    EXPECT_TRUE(verdict("rmse.H(a) == 0.125")) << "no n: the highest sample count, as the experiment names none";
    EXPECT_TRUE(verdict("var.H(a, n=4, s=32) == 0.25"));
    EXPECT_TRUE(verdict("fireflies(a) == 5"));
    EXPECT_TRUE(verdict("furnace(white) == 0.27"));
    EXPECT_TRUE(verdict("furnace_error(white) <= 0.0300001"));
    EXPECT_FALSE(verdict("furnace_error(white) < 0.0299"));
    EXPECT_TRUE(verdict("shape_pixels(ball) == 120"));
    EXPECT_TRUE(verdict("region_pixels(H) == 8"));
    EXPECT_TRUE(verdict("geometry_pixels >= 500"));
    EXPECT_TRUE(verdict("plate_bytes(hero) > 0"));
    EXPECT_FALSE(verdict("plate_bytes(rose) > 0"));
}

TEST(Assertions, RmseWithinReferenceErrorDoesNotPass) {
    Metrics m = measured();
    m.references.resize(1);
    m.references[0].s = 32;
    m.references[0].region = "H";
    m.references[0].quadrature_error = 0.1;
    m.references[0].rms_standard_error = 9;
    EXPECT_TRUE(verdict("rmse.H(a, n=4) < 1", false, m)) << "0.5 is five times the error";
    EXPECT_FALSE(verdict("rmse.H(a, n=16) < 1", false, m)) << "0.125 is not";
    EXPECT_FALSE(verdict("rmse.H(a, n=16) < rmse.H(a, n=4)", false, m));
    const AssertionResult describe = evaluate_assertions(two_arms({{"rmse.H(a, n=16) < 1", false}}), m, {}).at(0);
    EXPECT_FALSE(describe.reference_good);
    EXPECT_NE(describe.text.find("not good enough"), std::string::npos) << describe.text;
    EXPECT_NE(describe.reference_fault.find("region H is 0.1, and at most 0.03125 is needed"), std::string::npos)
        << describe.reference_fault;
    EXPECT_NE(describe.reference_fault.find("reference.kind = \"paired\""), std::string::npos);
    Experiment of_article = two_arms({{"rmse.H(a, n=16) < 1", false}});
    of_article.reference.kind = ReferenceKind::note;
    m.references[0].rms_standard_error = 0.125;  // four times the quarter of 0.125: 16 times the samples
    EXPECT_NE(evaluate_assertions(of_article, m, {}).at(0).reference_fault.find("disk_spp is 96, about 1536 is needed"),
        std::string::npos);
    of_article.reference = {.kind = ReferenceKind::paired, .n = 100};
    for (RunMetrics& run : m.runs)
        for (RegionMetrics& region : run.regions) region.mse_error = 0.125 * 0.125 / 4 / 1.96;  // four times 1/16
    EXPECT_NE(
        evaluate_assertions(of_article, m, {}).at(0).reference_fault.find("reference.n is 100, about 1600 is needed"),
        std::string::npos);
}

TEST(Assertions, HoldAtTheSeedOrOnTheMedianAsTheySay) {
    EXPECT_FALSE(verdict("rmse.H(b, n=4) < rmse.H(a, n=4)"));
    EXPECT_TRUE(verdict("rmse.H(b, n=4) < rmse.H(a, n=4)", true));
    const auto result =
        evaluate_assertions(two_arms({{"rmse.H(b, n=4) < rmse.H(a, n=4)", true}}), measured(), {}).at(0);
    EXPECT_EQ(result.measured, 0.25);
    EXPECT_EQ(result.bound, 1);
    EXPECT_EQ(result.text, "rmse.H(b, n=4) < rmse.H(a, n=4) (medians over seeds)");
}

TEST(Assertions, AreSkippedWithoutTheSeedsTheyNeed) {
    const auto all = two_arms({{"rmse.H(b, n=4) < rmse.H(a, n=4)", true}, {"fireflies(a) == 5", false},
        {"furnace(white) == 0.27", true}, {"region_pixels(H) == 8", false}, {"1 > furnace(white)", true}});
    const auto skipped = [&](const Metrics& m) {
        std::vector<std::string> out;
        for (const AssertionResult& a : evaluate_assertions(all, m, {})) {
            out.push_back(a.skipped);
            EXPECT_TRUE(a.pass != !a.skipped.empty()) << a.name;
            EXPECT_FALSE(a.failed()) << a.name;
        }
        return out;
    };
    Metrics m = measured();
    m.series = {5, 6, 7};
    EXPECT_EQ(skipped(m), std::vector<std::string>(5));
    m.series = {5, 6, 7, 8};
    EXPECT_EQ(skipped(m), (std::vector<std::string>{"needs seeds 1 to 4", "", "", "", ""}));
    m.series = {4, 5, 6, 7};
    EXPECT_EQ(skipped(m), (std::vector<std::string>{"needs seeds 1 to 4", "needs seed 1", "", "", ""}));
}

TEST(Assertions, OfTailsAndFurnacesAreSkippedWithoutStudies) {
    Metrics m = measured();
    m.has_studies = false;
    m.furnaces.clear();
    const auto results = evaluate_assertions(
        two_arms({{"furnace(white) == 0.27", false}, {"tail.H(a, n=4) < 1", false}, {"fireflies(a) == 5", false}}), m,
        {});
    EXPECT_EQ(results[0].skipped, "tails and furnaces were left out");
    EXPECT_EQ(results[1].skipped, "tails and furnaces were left out");
    EXPECT_EQ(results[2].skipped, "");
    EXPECT_TRUE(results[2].pass);
}

TEST(Assertions, FailOnWhatIsNotANumberOrWasNotMeasured) {
    Metrics m = measured();
    m.runs[0].regions[0].rmse = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(verdict("rmse.H(a, n=4) < 1e9", false, m));
    EXPECT_FALSE(verdict("rmse.H(a, n=4) > 0", true, m));
    EXPECT_FALSE(verdict("rmse.H(a, n=5) > 0"));
    EXPECT_FALSE(verdict("rmse.G(a, n=4) > 0"));
    EXPECT_FALSE(verdict("furnace(black) > 0"));
    EXPECT_FALSE(verdict("tail.H(a, n=4) < 1"));
    m.runs[0].regions[0].tail = Tail{0.3, 0.1, 50};
    EXPECT_TRUE(verdict("tail.H(a, n=4) < 1", false, m));
}

}  // namespace assertions_test
}  // namespace crescent
