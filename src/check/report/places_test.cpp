// The shares of draws and p in the named region, and their concentration.
#include "check/report/places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/explained.h"

namespace crescent::check {
namespace places_test {

using ::testing::HasSubstr;
using Comparison = Concentration::Comparison;

const CheckAt& at(const Explained& r) { return r.outcomes.at(0).checks.at(0).at(0); }
std::optional<ShareDifference> difference_in(const Explained& r) {
    const CheckAt& c = at(r);
    return largest_difference(*c.plan, c.integrals, c.observations);
}

TEST(DifferencesOfShares, AreThoseOfTheRegion) {
    // 40 % of the draws go to x > 0, where p has a half.
    const auto draw = [](Vec3d o, const PrimarySample& u) {
        Vec3d w = cosine_draw(o, u);
        w.x = std::fabs(w.x) * (u[2] < 0.4 ? 1 : -1);
        return w;
    };
    const Explained r = checked(made(draw, cosine_pdf, 3));
    const auto d = difference_in(r);
    ASSERT_TRUE(d);
    EXPECT_TRUE(d->drawn_share > 0 && d->drawn_share < 1 && d->claimed_share > 0 && d->claimed_share < 1);
    const Vec3d w = from_chart(d->rect.at(0.5, 0.5));
    EXPECT_NEAR(d->drawn_share / d->claimed_share, w.x > 0 ? 0.8 : 1.2, 5 * d->drawn_error / d->claimed_share);
    EXPECT_THAT(sentence_of(*d, {}).text, HasSubstr("Of the draws"));
    const Explained constant = checked(made(cosine_draw, [](Vec3d o, Vec3d v) { return 1.5 * cosine_pdf(o, v); }));
    EXPECT_FALSE(difference_in(constant));  // it changes no share
}

TEST(Regions, HaveEndsThatDiffer) {
    const double above = 1 - 0x1p-16;
    const ChartRect wide{.t0 = 0.5, .t1 = 1, .phi0 = 0, .phi1 = two_pi / 4};
    const ChartRect thin{.t0 = above, .t1 = 1, .phi0 = 0, .phi1 = two_pi / 4};
    EXPECT_EQ(region_text(wide, {}), "at polar angles 60 to 90 deg, azimuths 0 to 90 deg");
    EXPECT_EQ(region_text(thin, {}), "at polar angles 89.999 to 90 deg, azimuths 0 to 90 deg");
}

TEST(ConcentrationOfDraws, IsComparedWithThatOfP) {
    const auto compared = [](double drawn, double claimed, Vec3d axis) {
        const Explained r = checked(made([=](Vec3d, const PrimarySample& u) { return power_draw(axis, drawn, u); },
            [=](Vec3d, Vec3d w) { return power_pdf({0, 0, 1}, claimed, w); }, 2, Traits::WoDomain::none));
        const auto out = concentration_of(at(r));
        EXPECT_TRUE(out);
        return out.value_or(Concentration{}).comparison;
    };
    EXPECT_EQ(compared(30, 20, {0, 0, 1}), Comparison::more);
    EXPECT_EQ(compared(20, 30, {0, 0, 1}), Comparison::less);
    EXPECT_EQ(compared(50, 50, tilt(15, 40)), Comparison::same);
}

TEST(ConcentrationOfDraws, IsThatOfAUniformDensityInItsSupport) {
    const auto draw = [](Vec3d, const PrimarySample& u) { return from_chart({0.5 * u[0], two_pi * u[1]}); };
    const Explained r = checked(made(draw, [](Vec3d, Vec3d w) { return w.z > 0 ? 1 / two_pi : 0; }));
    const auto out = concentration_of(at(r));
    ASSERT_TRUE(out);
    EXPECT_NEAR(out->drawn_solid_angle / (two_pi / 2), 1, 0.03);
    EXPECT_NEAR(out->claimed_solid_angle / two_pi, 1, 0.03);
    EXPECT_EQ(out->comparison, Comparison::more);
}

TEST(DifferencesOfShares, AreSaidInOneWordingAtEveryWo) {
    const Explained r = checked(made([](Vec3d o, const PrimarySample& u) { return power_draw(mirror(o), 30, u); },
                                    [](Vec3d o, Vec3d w) { return power_pdf(mirror(o), 24, w); }),
        {{10, 0}, {40, 60}, {60, 200}});
    for (const Verdict& v : r.verdicts())
        if (v.name == "density") {
            EXPECT_EQ(v.state, State::wrong);
            ASSERT_EQ(v.sentences.size(), 2u) << v.message();
            EXPECT_EQ(v.sentences[0].what, "share of a region");
            EXPECT_EQ(v.sentences[1].what, "more concentrated");
            EXPECT_TRUE(v.size > 0 && v.size < 1);
        }
}

}  // namespace places_test
}  // namespace crescent::check
