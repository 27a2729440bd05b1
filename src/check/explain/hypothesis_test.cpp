// Hypotheses about the density of the draws: their likelihood, equivalence, and whether the corrected sampler passes.
#include "check/explain/hypothesis.h"

#include <gtest/gtest.h>

#include "check/explain/factors.h"
#include "check/explain/regression.h"
#include "tests/support/explained.h"

namespace crescent::check {
namespace hypothesis_test {

TEST(MassRatios, AreOfPOverTheDraws) {
    CheckAt c;
    Observations& o = c.observations;
    o.independent = 100;
    o.sums[mass] = {80, 80};  // 80 of 100 draws are directions
    c.integrals.sums[mass] = {1.6, 0.0004, 0};
    const MassRatio m = mass_ratio(c);
    EXPECT_DOUBLE_EQ(m.drawn_mass, 0.8);
    EXPECT_DOUBLE_EQ(m.claimed_mass, 1.6);
    EXPECT_DOUBLE_EQ(m.ratio, 2);
    EXPECT_NEAR(m.error, std::sqrt(0.0004 + 4 * 0.16 / 100) / 0.8, 1e-12);
    o.sums[bridge] = {40, 16.1};
    c.integrals.sums[bridge] = {0.82, 1e-6, 0};
    EXPECT_DOUBLE_EQ(mass_ratio(c).ratio, 0.82 / 0.4);  // more precise
}

class WrongDensity : public ::testing::Test {
protected:
    /// Draws follow a cosine, p is half of a uniform density.
    const Explained r =
        checked(made(cosine_draw, [](Vec3d, Vec3d w) { return w.z > 0 ? 0.5 / two_pi : 0; }), {{40, 30}, {70, 200}});
    const std::vector<Place> places = r.places(1024);
    const Factor cosine{"cos theta_i", [](Vec3d, Vec3d w) { return std::fabs(w.z); }},
        sine{"sin theta_i", [](Vec3d, Vec3d w) { return std::sqrt(1 - w.z * w.z); }};
};

TEST_F(WrongDensity, HasAPlaceForEachWo) {
    ASSERT_EQ(places.size(), 2u);
    EXPECT_NE(places[0].check_case->theta_deg, places[1].check_case->theta_deg);
    EXPECT_EQ(places[0].w.size(), 1024u);
    for (const Place& place : places) EXPECT_NEAR(mass_ratio(*place.check).ratio, 0.5, 0.01);
    double off = 0;  // the density that the leaves imply
    for (std::size_t i = 0; i < places[0].w.size(); ++i)
        off += std::fabs(places[0].implied[i] / cosine_pdf({}, places[0].w[i]) - 1) / 1024;
    EXPECT_LT(off, 0.25);
}

TEST_F(WrongDensity, TheTrueDensityHasTheLargestLikelihood) {
    Hypothesis right = times(cosine, 1), wrong = times(sine, 1);
    right.constants = {4, 4};
    wrong.constants = {8 / pi, 8 / pi};  // of mass 1
    score(right, places);
    score(wrong, places);
    // Under a cosine ln cos theta and ln sin theta both average -1/2.
    EXPECT_NEAR(right.gain, std::log(4) - 0.5, 0.05);
    EXPECT_NEAR(wrong.gain, std::log(8 / pi) - 0.5, 0.05);
    EXPECT_TRUE(right.helps());
    EXPECT_GT(right.explained_share, 0.9);
    EXPECT_LT(wrong.explained_share, 0.6);
    right.masses = {0.5, 0.5};  // half of the mass of p, which is half of that of the draws
    score(right, places);
    EXPECT_NEAR(right.gain, std::log(4) - 0.5 + 0.5 * 0.5, 0.05);
}

TEST_F(WrongDensity, OnlyTheTrueDensityPasses) {
    Hypothesis right = times(cosine, 1), wrong = times(sine, 1);
    EXPECT_TRUE(passes(right, places, 1));
    EXPECT_FALSE(passes(wrong, places, 1));
    EXPECT_NEAR(right.constant(0), 4, 0.04);
    EXPECT_FALSE(is_below_map(right, places));
    right.constants = {2, 2};
    EXPECT_TRUE(is_below_map(right, places));
}

TEST_F(WrongDensity, EqualDensitiesAreEquivalent) {
    Hypothesis one = times(cosine, 1), same = times(cosine, 1), other = times(cosine, 2);
    same.constants = {1.0005, 1.0005};
    EXPECT_TRUE(are_equivalent(one, same, places));
    EXPECT_FALSE(are_equivalent(one, other, places));
    same.constants = {1.1, 1.1};
    EXPECT_FALSE(are_equivalent(one, same, places));
}

}  // namespace hypothesis_test
}  // namespace crescent::check
