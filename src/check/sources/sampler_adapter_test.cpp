// Lights of a case, its text, and adapters that limit the number of queries.
#include "check/sources/sampler_adapter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/function_sampler.h"

namespace crescent::inline sources {
namespace {

constexpr CaseDiskLight overhead{20, {0, 0, 2}, {0, 0, -1}, 1};

TEST(CaseLights, AreMetAtTheirDistance) {
    EXPECT_DOUBLE_EQ(*overhead.distance({0, 0, 1}), 2);
    const double rim = std::atan(0.5) * 180 / pi;
    EXPECT_NEAR(*overhead.distance(tilt(rim - 0.1)), std::sqrt(5), 0.01);
    EXPECT_FALSE(overhead.distance(tilt(rim + 0.1)));
    CaseDiskLight turned = overhead;
    turned.normal = {0, 0, 1};
    EXPECT_FALSE(turned.distance({0, 0, 1}));  // its dark side
}

TEST(CaseLights, TheNearestCounts) {
    CaseLighting light;
    light.fill = 0.5;
    light.disks = {{12, {0, 0, 3}, {0, 0, -1}, 3}, overhead};
    EXPECT_FALSE(light.even());
    EXPECT_EQ(light({0, 0, 1}), 20);
    EXPECT_EQ(light.first_met({0, 0, 1})->distance, 2);
    EXPECT_EQ(light(tilt(40)), 12);
    EXPECT_EQ(light(tilt(80)), 0.5);
    EXPECT_EQ(light(tilt(100)), 0);
    EXPECT_TRUE(CaseLighting().even());
}

TEST(CaseLights, OfOtherKindsHaveTheirPower) {
    CaseAreaLight ball{3, lights::Sphere{{0, 0, 4}, 1}};
    EXPECT_NEAR(*ball.distance({0, 0, 1}), 3, 1e-9);
    EXPECT_FALSE(ball.distance(tilt(30)));
    CaseLighting light;
    light.area_lights = {ball};
    light.disks = {{20, {0, 0, 3.5}, {0, 0, -1}, 5}};  // behind the front of the ball
    EXPECT_EQ(light({0, 0, 1}), 3);
    EXPECT_EQ(light(tilt(45)), 20);
    ball.radiance = 6;
    EXPECT_DOUBLE_EQ(ball.power(), 2 * light.area_lights[0].power());
}

TEST(CheckCases, AreDescribedByTheirDirectionAndParameters) {
    CheckCase t;
    t.theta_deg = 60, t.azimuth_deg = 250, t.parameters = {{"s", 32}}, t.brdf = "Lambert", t.lighting = "fill";
    EXPECT_EQ(t.text(), "w_o 60 deg az 250, s=32, Lambert, fill");
    auto sky = std::make_shared<check::FunctionSampler>();
    sky->of.wo = Traits::WoDomain::none;
    CheckCase of_sky;
    of_sky.adapter = sky;
    EXPECT_EQ(of_sky.text(), without_wo);
    EXPECT_NEAR(tilt(30, 90).y, 0.5, 1e-12);
    EXPECT_NEAR(tilt(120).z, -0.5, 1e-12);
}

/// Counts its answers.
struct Counting : InProcessAdapter {
    std::string name() const override { return "counting"; }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw>) const override { count(u.size()); }
    void pdf(int, std::span<const Pair> at, std::span<double>) const override { count(at.size()); }
};

TEST(LimitedAdapters, RefuseTheQueryAboveTheirLimit) {
    const auto inner = std::make_shared<Counting>();
    const LimitedAdapter limited(inner, 10);
    std::vector<PrimarySample> u(6);
    std::vector<Draw> draws(6);
    std::vector<Pair> at(4);
    std::vector<double> p(4);
    limited.sample(0, {}, u, draws);
    limited.pdf(0, at, p);
    EXPECT_EQ(limited.spending().answers, 10u);
    EXPECT_THROW(limited.exact_pdf(0, std::span(at).first(1), std::span(p).first(1)), SamplerTimeout);
    EXPECT_EQ(inner->spending().answers, 10u);  // it was not called
}

}  // namespace
}  // namespace crescent::inline sources
