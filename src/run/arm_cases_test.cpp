// Arms of an experiment as cases of check: their number, densities in closed form, weights that sum to one.
#include "run/arm_cases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/errors.h"
#include "experiment/combinations.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace arm_cases_test {

using ::testing::HasSubstr;

Experiment scene(std::vector<std::string> more = {}) {
    more.insert(more.end(), {"image.width=32", "image.height=24", "regions.all.box=[0,0,31,23]"});
    return test::small_scene(more);
}

/// Returns the density of a technique, and f, at w_i for the case's w_o.
std::pair<double, double> at(const CheckCase& c, Vec3d wi, int technique = 0) {
    const Pair pair{c.wo, wi};
    double pdf = 0, f = 0;
    c.adapter->pdf(technique, {&pair, 1}, {&pdf, 1});
    c.adapter->f({&pair, 1}, {&f, 1});
    return {pdf, f};
}

TEST(ArmCases, CoverTheGridOnEachMaterial) {
    const auto grid = arm_cases(scene(), "phong", {}, {}), full = arm_cases(scene(), "phong", {}, {.full = true});
    EXPECT_EQ(grid.size(), 3u * 8 * 3);  // three shapes, 8 w_o, with uniform and cosine as baselines
    EXPECT_EQ(full.size(), 2 * grid.size());
    EXPECT_EQ(arm_cases(scene(), "uniform", {}, {}).size(), 3u * 8 * 2);
    std::set<std::string> materials;
    for (const CheckCase& c : grid) materials.insert(c.brdf);
    EXPECT_EQ(materials, (std::set<std::string>{"ball", "block", "ground"}));
}

TEST(ArmCases, HaveTheDensityAndBrdfOfTheirPoint) {
    const Vec3d wi = tilt(30, 20);
    for (const CheckCase& c : arm_cases(scene(), "cosine", {}, {.wo = {{40, 100}}})) {
        EXPECT_NEAR(c.theta_deg, 40, 1e-6);
        EXPECT_NEAR(dot(c.wo, tilt(40, 100)), 1, 1e-12);
        const auto [pdf, f] = at(c, wi);
        EXPECT_NEAR(pdf, (c.arm == "cosine" ? std::cos(pi / 6) : 0.5) / pi, 1e-6) << c.arm;
        if (c.brdf == "ground") EXPECT_NEAR(f, 0.5 / pi, 1e-6);
        if (c.brdf == "ball") EXPECT_EQ(c.parameters.at(0).second, 24);
        EXPECT_EQ(c.baseline, c.arm == "uniform");
        Draw draw;
        const PrimarySample u(0.25, 0.5);
        c.adapter->sample(0, c.wo, {&u, 1}, {&draw, 1});
        EXPECT_NEAR(draw.pdf / at(c, draw.wi).first, 1, 1e-5);
    }
}

TEST(ArmCases, WeightsOfTechniquesSumToOne) {
    const auto cases = arm_cases(scene(), "mis-balance", {}, {.wo = {{30, 0}}});
    ASSERT_EQ(cases[0].adapter->techniques(), 2);
    for (const double theta : {10.0, 40.0, 70.0}) {
        const Pair pair{cases[0].wo, tilt(theta, 200)};
        double first = 0, second = 0;
        cases[0].adapter->mis_weight(0, {&pair, 1}, {&first, 1});
        cases[0].adapter->mis_weight(1, {&pair, 1}, {&second, 1});
        EXPECT_NEAR(first + second, 1, 1e-6);
        const double p = at(cases[0], pair.wi, 0).first, q = at(cases[0], pair.wi, 1).first;
        EXPECT_NEAR(first, p / (p + q), 1e-6);
    }
}

TEST(ArmCases, PixelsAreSpreadOverThoseInView) {
    std::set<std::string> pixels;
    for (const CheckCase& c : arm_cases(scene(), "uniform", {}, {.pixels = 5, .wo = {{0, 0}}}))
        pixels.insert(c.lighting);
    EXPECT_EQ(pixels.size(), 5u);
    for (const CheckCase& c : arm_cases(scene(), "uniform", {}, {.pixels = 5})) {
        EXPECT_GT(c.wo.z, 0);
        EXPECT_NEAR(std::cos(c.theta_deg * pi / 180), c.wo.z, 1e-5);
    }
}

TEST(ArmCases, UnknownNamesAndEmptyViewsAreRefused) {
    try {
        (void)arm_cases(scene(), "cosin", {}, {.flag = "--arm"});
        FAIL();
    } catch (const InputError& e) { EXPECT_THAT(e.what(), HasSubstr("did you mean 'cosine'?")); }
    const Experiment away = scene({"camera.target=[0.0, 9.0, 20.0]"});
    EXPECT_THROW((void)arm_cases(away, "cosine", {}, {}), InputError);
}

TEST(ArmCases, OfACombinationEndWithItsTime) {
    Experiment e = scene();
    ArmPlan ris;
    ris.name = "ris";
    ris.combination.kind = CombinationKind::ris;
    ris.combination.of = {"cosine", "uniform"};
    ris.combination.candidates = 4096;
    e.arms.push_back(ris);
    ExternalSamplers outside;
    add_combinations(e, outside);
    const PrimarySample u(0.25, 0.5);
    const auto draw = [&](const CheckCase& c) {
        Draw draw;
        c.adapter->sample(0, c.wo, {&u, 1}, {&draw, 1});
    };
    for (const CheckCase& c : arm_cases(e, "ris", outside, {.wo = {{30, 0}}, .seconds = 1e-9}))
        if (c.baseline) EXPECT_NO_THROW(draw(c));
        else EXPECT_THROW(draw(c), SamplerTimeout);
    for (const CheckCase& c : arm_cases(e, "ris", outside, {.wo = {{30, 0}}})) EXPECT_NO_THROW(draw(c));
}

/// The cosine lobe without a function pdf.
class DrawsAlone : public SamplerSource {
public:
    std::string name() const override { return "draws"; }
    Traits traits() const override { return {.has_pdf = false}; }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            const double r = std::sqrt(u[i].x), z = std::sqrt(1 - u[i].x);
            const math::SinCos phi = math::sincos(2 * pi * u[i].y);
            out[i] = {{r * phi.cos, r * phi.sin, z}, z / pi};
        }
    }
    void pdf(int, std::span<const Pair>, std::span<double>) const override { FAIL() << "there is none"; }
};

TEST(ArmCases, WithoutAPdfHaveTheWeightsOfTheirDraws) {
    Experiment e = scene();
    ArmPlan mine;
    mine.name = "mine";
    mine.exec = "./mine";
    e.arms.push_back(mine);
    const ExternalSamplers outside = {{"mine", std::make_shared<DrawsAlone>()}};
    const PrimarySample u(0.25, 0.5);
    for (const CheckCase& c : arm_cases(e, "mine", outside, {.wo = {{30, 0}}})) {
        if (c.baseline) continue;
        EXPECT_FALSE(c.adapter->traits().has_pdf);
        Draw draw;
        double f = 0, p = -1;
        c.adapter->sample(0, c.wo, {&u, 1}, {&draw, 1});
        const Pair pair{c.wo, draw.wi};
        c.adapter->f({&pair, 1}, {&f, 1});
        c.adapter->pdf(0, {&pair, 1}, {&p, 1});
        EXPECT_EQ(draw.pdf, 1);
        EXPECT_NEAR(draw.weight.value(), f * pi, 1e-6 * f);
        EXPECT_EQ(p, 0);
    }
}

TEST(ArmCases, KeepTheArmsThatAnArmCombines) {
    Experiment e = scene();
    ArmPlan both;
    both.name = "both";
    both.combination.of = {"cosine", "inner"};
    ArmPlan inner;
    inner.name = "inner";
    inner.combination.of = {"phong"};
    e.arms.push_back(both);
    e.arms.push_back(inner);
    std::vector<std::string> names;
    for (const ArmPlan& arm : with_arms_of(e, {"both"}).arms) names.push_back(arm.name);
    EXPECT_EQ(names, (std::vector<std::string>{"cosine", "phong", "both", "inner"}));
    EXPECT_EQ(with_arms_of(e, {"uniform"}).arms.size(), 1u);
}

}  // namespace arm_cases_test
}  // namespace crescent
