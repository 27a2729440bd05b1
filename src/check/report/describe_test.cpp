// Distributions with known moments and support: a cosine, a cone, and one with a delta part.
#include "check/report/describe.h"

#include <cmath>
#include <gtest/gtest.h>

#include "samplers/domains/sphere_chart.h"

namespace crescent::check {
namespace describe_test {

/// Uniform over a cone of half angle `angle`, 60 degrees from n; a share of the draws is a delta part, another returns
/// no sample.
struct ConeOfDraws : SamplerSource {
    double angle = 0.5, delta = 0, nothing = 0;
    bool cosine = false, below = false;
    std::string name() const override { return "cone"; }
    Traits traits() const override {
        Traits t;
        t.numbers = 3;
        t.delta = delta > 0;
        return t;
    }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            const double z = cosine ? std::sqrt(u[i].x) : 1 - (1 - std::cos(angle)) * u[i].x, r = std::sqrt(1 - z * z);
            const Vec3d w{r * std::cos(two_pi * u[i].y), r * std::sin(two_pi * u[i].y), z};
            // Rotated by 60 degrees about y; the cosine stays about n.
            const Vec3d turned =
                cosine ? w : Vec3d{0.5 * w.x + std::sqrt(0.75) * w.z, w.y, 0.5 * w.z - std::sqrt(0.75) * w.x};
            out[i] = {below && u[i][2] > 0.75 ? Vec3d{turned.x, turned.y, -turned.z} : turned, 1.0};
            if (u[i][2] < delta) {
                out[i].pdf = 0;
                out[i].delta = delta;
                out[i].weight = 1;
            } else if (u[i][2] < delta + nothing) out[i].pdf = 0;
        }
    }
    void pdf(int, std::span<const Pair>, std::span<double> out) const override { std::ranges::fill(out, 1.0); }
};

Description described(const ConeOfDraws& s) {
    CheckCase t;
    t.arm = "cone";
    t.wo = {0, 0, 1};
    t.adapter = std::make_shared<ConeOfDraws>(s);
    ProgressMonitor monitor;
    return describe({&t, 1}, {}, monitor).at(0);
}
/// Tests that the true value is within twice the distance of the ends.
void expect_near(const Interval& i, double truth) {
    EXPECT_LE(i.low, i.value);
    EXPECT_LE(i.value, i.high);
    EXPECT_GE(truth, i.value - 2 * (i.value - i.low) - 1e-12);
    EXPECT_LE(truth, i.value + 2 * (i.high - i.value) + 1e-12);
}

TEST(DescriptionOfDraws, HasTheMomentsOfACosine) {
    ConeOfDraws s;
    s.cosine = true;
    const Description d = described(s);
    EXPECT_EQ(d.above_share.value, 1);
    EXPECT_EQ(d.below_share.value, 0);
    expect_near(d.mean[2], 2.0 / 3);
    expect_near(d.second_moments[0], 0.25);
    expect_near(d.second_moments[2], 0.5);
    expect_near(d.second_moments[3], 0);
    expect_near(d.angles[0], std::acos(std::sqrt(0.5)));
    // 1 / integral of cos^2 / pi^2 over the hemisphere = 3 pi / 2.
    EXPECT_NEAR(d.effective_solid_angle.value, 1.5 * two_pi / 2, 0.1);
    EXPECT_EQ(d.theta_edges.size(), 10u);
    double sum = 0;
    for (const Interval& i : d.map) sum += i.value;
    EXPECT_NEAR(sum, 1, 1e-9);
}

TEST(DescriptionOfDraws, HasTheAxisAndTheSolidAngleOfACone) {
    const Description d = described({});
    // sqrt(chi-square of two degrees at 95 %) sqrt(E[sin^2] / 2 / n) over the length of the mean.
    EXPECT_NEAR(d.direction_error, 2.47e-3, 5e-5);
    EXPECT_NEAR(d.theta, two_pi / 6, 2 * d.direction_error);
    EXPECT_LT(std::min(d.phi, two_pi - d.phi), 2 * d.direction_error / std::sin(d.theta));
    const double solid_angle = two_pi * (1 - std::cos(0.5));
    // Cells at the rim extend beyond it by a few per cent.
    EXPECT_NEAR(d.solid_angle.value / (0.95 * solid_angle), 1, 0.06);
    EXPECT_NEAR(d.effective_solid_angle.value / solid_angle, 1, 0.06);
    EXPECT_LE(d.solid_angle.low, d.solid_angle.value);
    EXPECT_LE(d.solid_angle.value, d.solid_angle.high);
}

TEST(DescriptionOfDraws, CountsEachKindOfDraw) {
    ConeOfDraws s;
    s.delta = 0.25;
    s.nothing = 0.125;
    s.below = true;
    s.cosine = true;
    const Description d = described(s);
    expect_near(d.delta_share, 0.25);
    expect_near(d.empty_share, 0.125);
    expect_near(d.below_share, 0.25);
    expect_near(d.above_share, 0.375);
    EXPECT_EQ(d.theta_edges.size(), 19u);
    const std::string text = description_text(d);
    for (const char* word : {"above the horizon", "delta parts", "nothing", "effective support", "map"})
        EXPECT_NE(text.find(word), std::string::npos) << text;
    const auto json = description_json({&d, 1});
    EXPECT_EQ(json[0]["map"]["rows"].size(), 18u * 24);
    EXPECT_NEAR(json[0]["share_below"]["value"].get<double>(), d.below_share.value, 1e-12);
}

}  // namespace describe_test
}  // namespace crescent::check
