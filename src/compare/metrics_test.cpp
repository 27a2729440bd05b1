// Metrics of renders with two pixels and means over renders, computed by hand.
#include "compare/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/memory_renders.h"

namespace crescent {
namespace metrics_test {

Render grey(std::vector<float> values) {
    Render out("r", static_cast<int>(values.size()), 1);
    out.r = out.g = out.b = std::move(values);
    return out;
}

TEST(MeanFilm, HasMeansAndVariancesOverRenders) {
    MeanFilm film;
    for (const float x : {1.0f, 2.0f, 6.0f}) film.add(grey({x, 4}));
    ASSERT_EQ(film.planes.size(), 1u);
    EXPECT_NEAR(film.y()[0], 3, 1e-6);
    EXPECT_NEAR(film.variance(0), 7, 1e-5);
    EXPECT_NEAR(film.variance(1), 0, 1e-12);
    EXPECT_NEAR(film.variance(0, 3), 7, 1e-5);  // every channel of a grey film is Y
}

TEST(MeanFilm, BecomesColouredWithTheFirstColour) {
    MeanFilm film;
    film.add(grey({1}));
    Render red = grey({1});
    red.r[0] = 3;
    film.add(red);
    ASSERT_EQ(film.planes.size(), colour_quantities);
    EXPECT_NEAR(film.of(1).mean[0], 2, 1e-6);
    EXPECT_NEAR(film.variance(0, 1), 2, 1e-5);
    EXPECT_NEAR(film.variance(0, 2), 0, 1e-12);
    EXPECT_NEAR(film.variance(0, 0), 2 * 0.2126 * 0.2126, 1e-6);
    EXPECT_EQ(film.radiance(0), std::vector<float>{2});
}

TEST(MeanFilm, HasTheStatedVarianceIfEveryRenderStatesIt) {
    Render render = grey({1});
    render.variance = {8};
    MeanFilm film;
    film.add(render, 0.25);
    EXPECT_DOUBLE_EQ(film.variance(0), 2);
    EXPECT_TRUE(std::isnan(MeanFilm(film).variance(0, 1)) || film.planes.size() == 1);
    film.add(render);
    EXPECT_EQ(film.stated_variance, std::vector<float>{10});
    film.add(grey({1}));
    EXPECT_TRUE(film.stated_variance.empty());
    MeanFilm unknown;
    unknown.add(render, 0);
    EXPECT_TRUE(std::isnan(unknown.variance(0)));
}

const CompareFlag reference{{"reference"}, "reference", false, ""}, no_flip{{"flip"}, "false", true, ""},
    spp{{"arms", "a", "spp"}, "16", true, ""}, seconds{{"arms", "a", "seconds"}, "2", true, ""};

TEST(RegionMetrics, FollowTheirDefinitions) {
    MemoryRenders m;
    m.put_grey("a0", 2, {2, 2});
    m.put_grey("a1", 2, {0, 4});
    m.put_grey("reference", 2, {1, 2}).variance = {0.1f, 0.3f};  // of its mean: 0.2
    const RegionResult r = m.compare({reference, no_flip, spp, seconds}).arms[0].regions[0];
    const auto value = [&](const char* name) { return r.metric(name).value.value_or(std::nan("")); };
    EXPECT_NEAR(value("rmse"), std::sqrt(1.5), 1e-6);  // of 0.5 and 2.5
    EXPECT_NEAR(value("var"), 2, 1e-6);                // of 2, 0 and of 2, 4
    EXPECT_NEAR(value("bias2"), -0.5 - 0.2, 1e-6);     // mean of e0 e1: (1 (-1) + 0 2) / 2, less the reference's error
    EXPECT_NEAR(value("y_mean"), 2, 1e-6);
    EXPECT_NEAR(value("efficiency"), 1 / (2 * 2.0), 1e-6);
    EXPECT_NEAR(value("unit_time"), 4, 1e-6);
    EXPECT_NEAR(value("sample_var"), 32, 1e-5);
    EXPECT_FALSE(r.metric("flip").value);
    EXPECT_FALSE(r.metric("var").interval);  // two renders have equal spreads
    EXPECT_NEAR(r.largest_share, 4 / 6.0, 1e-6);
    EXPECT_TRUE(r.heavy());
}

TEST(RegionMetrics, WithoutReferenceOrNoiseHaveNoValue) {
    MemoryRenders m;
    m.put("a", 1);
    const RegionResult one = m.compare({seconds}).arms[0].regions[0];
    EXPECT_FALSE(one.metric("rmse").value);
    EXPECT_FALSE(one.metric("var").value);
    EXPECT_FALSE(one.metric("efficiency").value);
    EXPECT_TRUE(one.metric("y_mean").value);
    EXPECT_FALSE(one.metric("y_mean").interval);
    m.renders["a"].variance.assign(256, 0.5f);
    EXPECT_NEAR(*m.compare({seconds}).arms[0].regions[0].metric("unit_time").value, 1, 1e-6);
}

TEST(RegionMetrics, AStatedVarianceIsComparedWithThatOverRenders) {
    MemoryRenders m;
    for (std::uint32_t k = 0; k < 6; ++k) m.put("a" + std::to_string(k), k).variance.assign(256, 0.04f);
    const RegionResult r = m.compare().arms[0].regions[0];
    EXPECT_NEAR(*r.stated_ratio, 0.04 / *r.metric("var").value, 1e-5);
    EXPECT_NEAR(*r.stated_ratio, 4, 0.5);  // the noise has a variance of 0.01
}

TEST(RegionMetrics, TailsDecideWhichMeansHaveIntervals) {
    const auto heavy = [](double k, double share) {
        RegionResult r;
        r.tail = Tail{k, 0.1, 50};
        r.largest_share = share;
        return std::pair(r.heavy(), r.mean_heavy());
    };
    EXPECT_EQ(heavy(0.4, 0.1), std::pair(false, false));
    EXPECT_EQ(heavy(0.5, 0.1), std::pair(true, false));  // of squares: half the index of the errors themselves
    EXPECT_EQ(heavy(1.0, 0.1), std::pair(true, true));
    EXPECT_EQ(heavy(0.1, 0.6), std::pair(true, true));
}

}  // namespace metrics_test
}  // namespace crescent
