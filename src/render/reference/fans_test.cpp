// Shadows whose edges cross a light: bodies that each hide one part of it and together all of it. The visible parts add
// up to the whole light, whose Lambert integral is known in closed form.
#include "render/reference/fans.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/reference/disk_quadrature.h"

namespace crescent {
namespace fans_test {

constexpr double far_away = 40;

/// Returns a point at the origin under a disk, with a tilted normal.
DiskPoint lambert_point(const shapes::Disk& light) {
    Surface surface{};
    surface.rho_d = {0.5, 0.5, 0.5};
    const Frame<double> frame = frame_about(normalize(Vec3d{0.3, -0.2, 1}));
    return {{0, 0, 0}, {0, 0, 1}, frame, surface, light.normal};
}

const shapes::Disk light = {{0.15, 0.1, 2}, {0, 0, -1}, 0.6};

/// Returns the part that one wall leaves visible.
double open_part(const shapes::Quad& wall) {
    const Blocker blocker{{wall}};
    const DiskPoint point = lambert_point(light);
    const Figure figure = light;
    const std::vector<const Blocker*> near = {&blocker};
    AllFans fans(point, figure, near, false, false);
    return fan_by_fan(point, fans).diffuse;
}

double whole() { return whole_disk(lambert_point(light), light, frame_about(light.normal)).diffuse; }

/// Returns a wall at height 1 in the quadrant of two vectors, effectively infinite.
shapes::Quad quadrant(Vec3d corner, Vec3d a, Vec3d b) { return {corner, far_away * a, far_away * b}; }

TEST(Fans, TwoHalvesOfALightAreTheWhole) {
    for (int k = 0; k < 200; ++k) {
        const double turn = 0.37 * k, off = 0.5 * 0.6 * std::sin(1.3 * k);  // nearer than the light: half its size
        const Vec3d across = {std::cos(turn), std::sin(turn), 0}, along = {-across.y, across.x, 0};
        const Vec3d edge = Vec3d{0.075, 0.05, 1} + off * across;
        const shapes::Quad left = {edge - far_away * along, -far_away * across, 2 * far_away * along},
                           right = {edge - far_away * along, far_away * across, 2 * far_away * along};
        EXPECT_NEAR((open_part(left) + open_part(right)) / whole(), 1, 1e-6) << "edge " << off << " turn " << turn;
    }
}

TEST(Fans, FourQuartersOfALightAreTheWhole) {
    for (int k = 0; k < 200; ++k) {
        const double turn = 0.53 * k, from = 0.3 * std::sqrt((k + 0.5) / 200);
        const Vec3d corner = Vec3d{0.075, 0.05, 1} + from * Vec3d{std::cos(2.4 * k), std::sin(2.4 * k), 0};
        const Vec3d a = {std::cos(turn), std::sin(turn), 0}, b = {-a.y, a.x, 0};
        double sum = 0;
        for (const shapes::Quad& wall :
            {quadrant(corner, a, b), quadrant(corner, b, -a), quadrant(corner, -a, -b), quadrant(corner, -b, a)})
            sum += whole() - open_part(wall);
        EXPECT_NEAR(sum / whole(), 1, 5e-6) << "corner " << from << " turn " << turn;
    }
}

}  // namespace fans_test
}  // namespace crescent
