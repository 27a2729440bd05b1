// The place of the draws: a uniform share, a curve, a part of where p is positive.
#include "check/explain/spread.h"

#include <gtest/gtest.h>

#include "math/functions.h"
#include "tests/support/explained.h"

namespace crescent::check {
namespace spread_test {

TEST(PlacesOfDraws, ALeakIsMeasured) {
    const auto draw = [](Vec3d, const PrimarySample& u) {
        return u[2] < 0.02 ? from_chart({u[0], two_pi * u[1]}) : power_draw({0, 0, 1}, 50, u);
    };
    const Explained r = explained(made(draw, [](Vec3d, Vec3d w) { return power_pdf({0, 0, 1}, 50, w); }, 3));
    expect_cause(r, "leak");
    EXPECT_NEAR(r.cause ? r.cause->exponent : 0, 0.02, 0.004) << r.text();
}

TEST(PlacesOfDraws, ANumberWithoutEffectLeavesACurve) {
    const auto draw = [](Vec3d o, const PrimarySample& u) { return cosine_draw(o, PrimarySample{u[0], 0.3}); };
    const Explained r = explained(made(draw, cosine_pdf));
    expect_cause(r, "curve");
    EXPECT_NE(r.text().find("u2 has no effect"), std::string::npos);
}

TEST(PlacesOfDraws, ADeltaPartThatIsNotDeclaredIsNamed) {
    const auto mixed = [](Vec3d o, const PrimarySample& u) { return u[2] < 0.25 ? mirror(o) : cosine_draw(o, u); };
    const Explained r = explained(made(mixed, [](Vec3d o, Vec3d w) { return 0.75 * cosine_pdf(o, w); }, 3));
    expect_cause(r, "delta");
    EXPECT_NEAR(r.cause ? r.cause->exponent : 0, 0.25, 0.04) << r.text();
    const Explained one = explained(made([](Vec3d, const PrimarySample&) { return tilt(30, 10); }, cosine_pdf));
    expect_cause(one, "delta");
    EXPECT_NE(one.text().find("All of the draws have one direction"), std::string::npos) << one.text();
}

TEST(PlacesOfDraws, MayNotCoverWherePIsPositive) {
    const double density = 1 / (two_pi * 0.05);
    const auto draw = [](Vec3d, const PrimarySample& u) { return from_chart({0.05 * u[0], two_pi * u[1]}); };
    const Explained r = explained(made(draw, [density](Vec3d, Vec3d) { return density; }, 2, Traits::WoDomain::none));
    expect_cause(r, "unreached");
    const auto with_pole = [density](Vec3d, Vec3d w) {
        return w.z > 0.95 ? density : 1e-3 / math::pow(std::max(1 + w.z, 1e-30), 1.5);
    };
    const Explained infinite = explained(made(draw, with_pole, 2, Traits::WoDomain::none));
    expect_cause(infinite, "unreached");
    EXPECT_NE(infinite.text().find("where its points resolve it"), std::string::npos) << infinite.text();
}

TEST(PlacesOfDraws, ALeakOverTheSphereIsDistinguished) {
    for (const bool covers_sphere : {false, true}) {
        const auto draw = [covers_sphere](Vec3d, const PrimarySample& u) {
            return u[2] < 0.1 ? from_chart({covers_sphere ? 2 * u[0] : u[0], two_pi * u[1]})
                              : power_draw({0, 0, 1}, 50, u);
        };
        FunctionSampler s =
            made(draw, [](Vec3d, Vec3d w) { return power_pdf({0, 0, 1}, 50, w); }, 3, Traits::WoDomain::both);
        s.change = [](const PrimarySample&, Draw& d) { d.pdf = std::max(d.pdf, 0.01); };
        const Explained r = checked(s);
        const std::vector<Leak> leaks = leak_hypotheses(r.places(1024));
        ASSERT_FALSE(leaks.empty());
        const auto best = std::ranges::max_element(leaks, {}, [](const Leak& l) { return l.hypothesis.gain; });
        EXPECT_EQ(best->covers_sphere, covers_sphere);
        EXPECT_TRUE(best->is_clear());
        EXPECT_NEAR(best->share, 0.1, 5 * best->error);
        EXPECT_LT(best->error, 0.01);
    }
}

}  // namespace spread_test
}  // namespace crescent::check
