// The kernels' results for points in a white furnace, against known values.
#include "metrics/furnace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/estimator.h"

namespace crescent {
namespace furnace_test {

TEST(BadSamples, PlantedNaNIsCountedAndReachesTheFilm) {
    Surface surface{{0.5, 0.5, 0.5}, 0.1, lobe_named("phong"), std::numeric_limits<double>::quiet_NaN(), 0};
    for (const std::string& isa : isas()) {
        const Moments m = estimate_points(furnace_points(surface, 3), "phong", 100, 1, isa, nullptr);
        EXPECT_EQ(m.bad[0], 100u) << isa;
        EXPECT_TRUE(std::isnan(m.g[0])) << isa;
    }
    surface.s = 32;
    EXPECT_EQ(estimate_points(furnace_points(surface, 3), "phong", 100, 1, "", nullptr).bad[0], 0u);
}

TEST(BadSamples, ANegativeWeightIsCounted) {
    const Surface surface{{-0.5, -0.5, -0.5}, 0, lobe_named("phong"), 0, 0};
    EXPECT_EQ(estimate_points(furnace_points(surface, 1), "cosine", 50, 1, "", nullptr).bad[0], 50u);
}

TEST(BadSamples, AMinusZeroOfTheMaterialIsNone) {
    const Surface black{{-0.0, -0.0, -0.0}, 0, lobe_named("phong"), 0, 0};
    EXPECT_EQ(estimate_points(furnace_points(black, 1), "cosine", 50, 1, "", nullptr).bad[0], 0u);
}

TEST(Furnace, CosineOnLambertHasNoVariance) {
    const Surface surface{{0.5, 0.5, 0.5}, 0, lobe_named("phong"), 0, 0};
    const Moments m = estimate_points(furnace_points(surface, 1), "cosine", 1000, 1, "", nullptr);
    EXPECT_NEAR(m.g[0] / 1000 / pi, 1, 1e-6);
    EXPECT_NEAR(m.spread[0] / 1000, 0, 1e-12);
    EXPECT_EQ(m.horizon[0], 0u);
}

}  // namespace furnace_test
}  // namespace crescent
