// The nearest light of a case along a direction.
#include "check/sources/case_lighting.h"

#include <cmath>
#include <gtest/gtest.h>

#include "check/sources/check_case.h"

namespace crescent {
namespace case_lighting_test {

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
    EXPECT_EQ(light.first_hit({0, 0, 1})->distance, 2);
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

}  // namespace case_lighting_test
}  // namespace crescent
