// Draws in another frame than p: mirrored, and turned by an angle that is measured.
#include "check/explain/frames.h"

#include <gtest/gtest.h>

#include "tests/support/explained.h"

namespace crescent::check {
namespace frames_test {

TEST(FramesOfDraws, AMirroredOneIsNamed) {
    const auto mirrored = [](Vec3d o, const PrimarySample& u) {
        return power_draw(mirror(Vec3d{o.x, -o.y, o.z}), 30, u);
    };
    const Explained r =
        explained(made(mirrored, [](Vec3d o, Vec3d w) { return power_pdf(mirror(o), 30, w); }), {{40, 50}, {60, 200}});
    ASSERT_TRUE(r.cause);
    EXPECT_NE(r.text().find("mirrored in y"), std::string::npos) << r.text();
}

TEST(FramesOfDraws, AreTurnedByAMeasuredAngle) {
    const Vec3d axis = tilt(50, 20), off = tilt(53, 20);
    const Explained r = checked(made([off](Vec3d, const PrimarySample& u) { return power_draw(off, 50, u); },
        [axis](Vec3d, Vec3d w) { return power_pdf(axis, 50, w); }, 2, Traits::WoDomain::none));
    const std::vector<Place> places = r.places();
    ASSERT_EQ(places.size(), 1u);
    const auto turn = turn_hypothesis(places);
    ASSERT_TRUE(turn);
    const Vec3d rotation = turn->turns[0].rotation;
    EXPECT_NEAR(std::sqrt(dot(rotation, rotation)), 3 * pi / 180, 5 * turn->turns[0].error);
    EXPECT_LT(turn->turns[0].error, 0.01);
    EXPECT_NEAR(
        dot(rotation, cross(axis, off)) / (std::sqrt(dot(rotation, rotation)) * std::sin(3 * pi / 180)), 1, 0.2);
}

// The columns of a table that begin a quarter later.
TEST(FramesOfDraws, AFrameTurnedAboutTheNormalIsNamed) {
    // A lobe about the mirror direction, and one that is fixed to the tangent.
    const auto about = [](Vec3d w, double angle) {
        const math::SinCos r = math::sincos(angle);
        return Vec3d{w.x * r.cos - w.y * r.sin, w.x * r.sin + w.y * r.cos, w.z};
    };
    const Vec3d axis = tilt(40, 0);
    const auto draw = [=](Vec3d o, const PrimarySample& u) {
        return u[2] < 0.5 ? power_draw(mirror(o), 40, u) : about(power_draw(axis, 40, u), 0.6);
    };
    const Explained r = explained(
        made(
            draw, [=](Vec3d o, Vec3d w) { return (power_pdf(mirror(o), 40, w) + power_pdf(axis, 40, w)) / 2; }, 3,
            Traits::WoDomain::both),
        {{20, 50}, {25, 200}});
    expect_cause(r, "turned about n");
    EXPECT_NEAR(std::fabs(r.cause ? r.cause->exponent : 0), 0.6, 0.02) << r.text();
}

TEST(FramesOfDraws, AnAzimuthIsFoundFromAnyAngle) {
    const Vec3d axis = tilt(60, 20), off = tilt(60, 110);
    const Explained r = checked(made([off](Vec3d, const PrimarySample& u) { return power_draw(off, 50, u); },
        [axis](Vec3d, Vec3d w) { return power_pdf(axis, 50, w); }, 2, Traits::WoDomain::none));
    const std::vector<Place> places = r.places(1024);
    ASSERT_EQ(places.size(), 1u);
    const auto turn = azimuth_hypothesis(places);
    ASSERT_TRUE(turn);
    EXPECT_TRUE(turn->is_clear());
    EXPECT_NEAR(turn->turns[0].rotation.z, pi / 2, 0.02);
    EXPECT_NEAR(turn->hypothesis.explained_share, 1, 0.1);
    const std::vector<Hypothesis> named = frame_hypotheses(places);
    ASSERT_FALSE(named.empty());
    EXPECT_EQ(named[0].name, "the azimuth turned by -90 deg for w_i");  // p at (y, -x, z)
}

}  // namespace frames_test
}  // namespace crescent::check
