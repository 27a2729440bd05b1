// The measurements for the shots of one pixel and of the tail, against the run's own films and against known values.
#include "measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/support/explainer_data.h"

namespace crescent::explainer {
namespace measures_test {

std::size_t at(const Film& film, const OpenPixel& pixel) {
    return std::size_t(pixel.j()) * std::size_t(film.width) + std::size_t(pixel.i());
}

TEST(Measures, TheSamplesOfThePixelAverageToTheFilm) {
    const Data& data = test::small_data();
    const PixelStory& story = data.measures->story;
    for (const ArmAtPixel* arm : {&story.cosine, &story.phong}) {
        const Film& film = *data.film(data.key(arm->arm));
        ASSERT_EQ(arm->mean.size(), film.n);
        EXPECT_EQ(arm->film, double(film.y[at(film, *story.pixel)]));
        EXPECT_NEAR(arm->mean.back(), arm->film, 2e-6 * arm->film);
        EXPECT_EQ(arm->largest_sample().x, film.largest[at(film, *story.pixel)]);
        EXPECT_EQ(arm->hits, film.light_hits[at(film, *story.pixel)]);
        EXPECT_EQ(arm->below_horizon, film.horizon[at(film, *story.pixel)]);
    }
}

TEST(Measures, ThePixelIsTheWorstOfItsRegion) {
    const Data& data = test::small_data();
    const OpenPixel& pixel = *data.measures->story.pixel;
    const Film& film = *data.film(data.key(data.cast.cosine));
    const auto error = [&](std::size_t k) { return std::fabs(double(film.y[k]) - double(data.reference().y[k])); };
    const Box& box = data.box(data.cast.highlight);
    ASSERT_TRUE(pixel.i() >= box.x0 && pixel.i() <= box.x1 && pixel.j() >= box.y0 && pixel.j() <= box.y1);
    for (int j = box.y0; j <= box.y1; ++j)
        for (int i = box.x0; i <= box.x1; ++i)
            EXPECT_LE(error(std::size_t(j) * std::size_t(film.width) + std::size_t(i)), error(at(film, pixel)));
}

TEST(Measures, OtherArmChangesOnlyTheDensityOfASample) {
    const PixelStory& story = test::small_data().measures->story;
    const PixelSample &a = story.cosine.largest_sample(), &b = story.by_phong;
    EXPECT_EQ(a.f, b.f);
    EXPECT_EQ(a.light, b.light);
    EXPECT_EQ(a.cos, b.cos);
    EXPECT_NEAR(double(a.x) * double(a.pdf), double(b.x) * double(b.pdf), 1e-5 * double(a.x) * double(a.pdf));
    for (const PixelSample& s : story.phong.samples)  // for draws of the arm, the pdf is that of the draw
        EXPECT_NEAR(story.pixel->pdf("phong", {double(s.wi.x), double(s.wi.y), double(s.wi.z)}), double(s.pdf),
            1e-3 * double(s.pdf));
}

TEST(Measures, TheDiskSharesOfThePixelAgreeWithDraws) {
    const PixelStory& story = test::small_data().measures->story;
    const double n = double(story.cosine.long_series), hits = n * story.cosine.hit_share;
    // The disk is at a cosine close to that of its centre: the share of cosine draws is its projected size.
    const double expected = story.solid_angle * story.pixel->lights()[0].towards.z / pi;
    EXPECT_NEAR(story.cosine.hit_share / expected, 1, 0.01 + 4 / std::sqrt(hits));
    double fill = 0, all = 0;
    for (const PixelSample& s : story.pixel->samples("mis-balance", 20000, 3)) {
        all += double(s.x);
        if (s.disk < 0) fill += double(s.x);
    }
    EXPECT_NEAR(1 - fill / all, story.disk_share, 0.003);
}

TEST(WeightTail, FollowsItsParetoDistribution) {
    for (const double s : {0.5, 4.0, 32.0}) {
        const WeightTail tail = weight_tail(s, 1 << 18, 5);
        EXPECT_EQ(std::accumulate(tail.bins.begin(), tail.bins.end(), std::uint64_t{0}), tail.n);
        if (s > 1) ASSERT_TRUE(tail.fit);
        if (s > 1) EXPECT_NEAR(tail.fit->k, tail.k, 4 * tail.fit->se);
        EXPECT_NEAR(tail.median, tail.smallest * std::exp2(tail.k), 0.01 * tail.median);
        for (std::size_t k = 0; k < tail.bins.size(); ++k)
            EXPECT_NEAR(double(tail.bins[k]), tail.expected(k), 5 * std::sqrt(tail.expected(k) + 1)) << "s = " << s;
    }
}

TEST(Measures, LostSupportOfPhongMatchesTheory) {
    const LostSupport& lost = test::small_data().measures->surround_lost;
    EXPECT_GT(lost.theta_R_deg, 10);
    EXPECT_NEAR(lost.measured, lost.theory, 4 * lost.se);
    EXPECT_GT(lost.theory, 20 * lost.se);
}

}  // namespace measures_test
}  // namespace crescent::explainer
