// Neighbours are surface points that the light reaches, but for one of eight, on the receiver's side.
#include "check/sources/neighbours.h"

#include <cmath>
#include <gtest/gtest.h>

#include "math/simd/math.h"

namespace crescent {

namespace {
namespace neighbours_test {

TEST(Neighbours, AreOnTheSideOfTheReceiver) {
    for (const Vec3d wo : {Vec3d{0, 0, 1}, normalize(Vec3d{1, 0.5, 0.02}), normalize(Vec3d{0.3, -0.8, -0.4})}) {
        int dark = 0;
        for (const Neighbour& each : neighbours_of(wo, 16)) {
            EXPECT_NEAR(length(each.n), 1, 1e-12);
            EXPECT_NEAR(length(each.wo), 1, 1e-12);
            EXPECT_GT(dot(each.n, each.wo) * wo.z, 0);
            EXPECT_NEAR(to_local(each, each.n).z, 1, 1e-12);
            dark += each.light == 0;
        }
        EXPECT_EQ(dark, 2);
    }
}

TEST(Neighbours, AreTheSameForTheSameDirection) {
    const Vec3d wo = normalize(Vec3d{0.2, 0.3, 0.9});
    std::vector<double> some, more;
    add_neighbours(neighbours_of(wo, 3), some);
    add_neighbours(neighbours_of(wo, 8), more);
    ASSERT_EQ(some.size(), 1 + 3 * Neighbour::columns);
    EXPECT_EQ(some[0], 3);
    EXPECT_TRUE(std::equal(some.begin() + 1, some.end(), more.begin() + 1));
}

}  // namespace neighbours_test
}  // namespace

}  // namespace crescent
