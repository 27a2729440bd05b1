// Lobes that one random number selects: their intervals, and the probabilities with which they are drawn.
#include "check/explain/lobes.h"

#include <gtest/gtest.h>

#include "tests/support/explained.h"

namespace crescent::check {
namespace lobes_test {

std::optional<LobeChooser> chooser(const FunctionSampler& s) {
    const CaseLighting light;
    Source source(s, 0, {0, 0, 1}, light);
    return chooser_of(source, {1, 0, 0, 1, Purpose::pairs});
}

TEST(LobesOfASampler, AreIntervalsOfOneNumber) {
    const Vec3d axes[] = {tilt(20), tilt(60, 120), tilt(70, 250)};
    FunctionSampler s;
    s.of.numbers = 3;
    s.draw = [&](Vec3d, const PrimarySample& u) {
        return power_draw(axes[u[2] < 0.3 ? 0 : u[2] < 0.45 ? 1 : 2], 40, u);
    };
    const auto found = chooser(s);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->number, 2);
    ASSERT_EQ(found->lobes.size(), 3u);
    EXPECT_NEAR(found->lobes[0].to, 0.3, 1e-6);
    EXPECT_NEAR(found->lobes[1].share(), 0.15, 1e-6);
    EXPECT_EQ(found->lobes[2].to, 1);
}

TEST(LobesOfASampler, MayBeSelectedByThePositionInANumber) {
    FunctionSampler s;  // the first number selects and is stretched
    s.draw = [](Vec3d, const PrimarySample& u) {
        const bool first = u.x < 0.25;
        return power_draw(
            first ? tilt(20) : tilt(60, 120), 4000, PrimarySample(first ? u.x / 0.25 : (u.x - 0.25) / 0.75, u.y));
    };
    const auto found = chooser(s);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->number, 0);
    EXPECT_NEAR(found->lobes[0].to, 0.25, 1e-6);
}

TEST(LobesOfASampler, AreNotFoundInASmoothMapOrATable) {
    EXPECT_FALSE(chooser(FunctionSampler()));
    FunctionSampler table;
    table.draw = [](Vec3d o, const PrimarySample& u) {
        return cosine_draw(o, PrimarySample(u.x, std::floor(32 * u.y) / 32));
    };
    EXPECT_FALSE(chooser(table));
}

TEST(LobesOfASampler, AreDrawnWithOtherProbabilities) {
    const Vec3d a = tilt(20, 0), b = tilt(60, 120);
    const auto draw = [a, b](Vec3d, const PrimarySample& u) { return power_draw(u[2] < 0.3 ? a : b, 40, u); };
    const Explained r = explained(made(
        draw, [a, b](Vec3d, Vec3d w) { return (power_pdf(a, 40, w) + power_pdf(b, 40, w)) / 2; }, 3,
        Traits::WoDomain::none));
    expect_cause(r, "chooser");
    EXPECT_NE(r.text().find("0.3, 0.7"), std::string::npos) << r.text();
}

/// A sampler that answers one caller at a time is asked for fewer draws, and for more of them where they would tell.
TEST(LobesOfASampler, OverlapInASamplerForOneCaller) {
    const auto draw = [](Vec3d o, const PrimarySample& u) {
        return u[2] < 0.3 ? cosine_draw(o, u) : power_draw(tilt(40), 3, u);
    };
    FunctionSampler sampler = made(
        draw, [](Vec3d, Vec3d w) { return (std::max(w.z, 0.0) / pi + power_pdf(tilt(40), 3, w)) / 2; }, 3,
        Traits::WoDomain::none);
    sampler.is_serial = true;
    const Explained r = explained(std::move(sampler));
    expect_cause(r, "chooser");
    EXPECT_NE(r.text().find("0.3, 0.7"), std::string::npos) << r.text();
}

TEST(LobesOfASampler, MayAllLackTheirProbability) {
    const Vec3d a = tilt(20, 0), b = tilt(60, 120);
    const auto draw = [a, b](Vec3d, const PrimarySample& u) { return power_draw(u[2] < 0.3 ? a : b, 40, u); };
    const Explained r = explained(made(
        draw, [a, b](Vec3d, Vec3d w) { return power_pdf(a, 40, w) + power_pdf(b, 40, w); }, 3, Traits::WoDomain::none));
    expect_cause(r, "chooser");
    EXPECT_NE(r.text().find("the chooser's probability of each is left out"), std::string::npos) << r.text();
}

/// Two lights whose p is per area: the factor of each, r^2 / cos, is missing, and p does not integrate to 1.
TEST(LobesOfASampler, MayEachHaveAFactor) {
    const Vec3d a = tilt(20, 0), b = tilt(60, 120);
    const auto draw = [a, b](Vec3d, const PrimarySample& u) { return power_draw(u[2] < 0.3 ? a : b, 40, u); };
    const Explained r = explained(made(
        draw, [a, b](Vec3d, Vec3d w) { return 0.06 * power_pdf(a, 40, w) + 0.35 * power_pdf(b, 40, w); }, 3,
        Traits::WoDomain::none));
    expect_cause(r, "chooser");
    EXPECT_NE(r.text().find("a factor that differs from lobe to lobe"), std::string::npos) << r.text();
    EXPECT_EQ(r.text().find("probability"), std::string::npos) << r.text();
}

}  // namespace lobes_test
}  // namespace crescent::check
