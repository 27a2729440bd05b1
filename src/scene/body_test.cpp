// The azimuths of random quads include the azimuth of each of their points.
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "scene/body.h"
#include "scene/shapes/box.h"
#include "scene/shapes/quad.h"

namespace crescent {
namespace body_test {

double azimuth_of(Vec3d d, const Frame<double>& frame) { return std::atan2(dot(d, frame.b), dot(d, frame.t)); }

TEST(Azimuths, HoldEveryPointOfAQuad) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto arrow = [&] { return Vec3d{number(random), number(random), number(random)}; };
    for (int k = 0; k < 3000; ++k) {
        const shapes::Quad quad = {arrow(), arrow(), arrow()};
        const Frame<double> frame = frame_about(normalize(arrow()));
        const Azimuths azimuths = quad.azimuths({}, frame);
        for (int n = 0; n < 20; ++n) {
            const double u = 0.5 + 0.5 * number(random), v = 0.5 + 0.5 * number(random);
            const double phi = azimuth_of(quad.corner + u * quad.edge_u + v * quad.edge_v, frame);
            EXPECT_TRUE(azimuths.meet(phi - 1e-9, phi + 1e-9))
                << phi << " of " << azimuths.middle << " +- " << azimuths.half;
        }
    }
}

/// Corners whose sum is zero give no direction to count from.
TEST(Azimuths, AreAllOfThemWhereTheAxisMeetsTheMiddle) {
    const Frame<double> up = frame_about(Vec3d{0, 0, 1});
    EXPECT_TRUE((shapes::Quad{{-1, -0.25, 2}, {2, 0, 0}, {0, 0.5, 0}}.azimuths({}, up).whole()));
    EXPECT_TRUE((shapes::Box{{-1, -2, 3}, {1, 2, 4}}.azimuths({}, up).whole()));
    EXPECT_FALSE((shapes::Quad{{1, -0.25, 2}, {2, 0, 0}, {0, 0.5, 0}}.azimuths({}, up).whole()));
}

}  // namespace body_test
}  // namespace crescent
