// The densities of the plate `rose` are those of the surface that the experiment's runs are drawn on.
#include <cmath>
#include <gtest/gtest.h>

#include "report/plates/charts.h"
#include "samplers/all.h"
#include "tests/support/skies.h"
#include "tests/support/test_scene.h"

namespace crescent::plates {
namespace charts_test {

/// Returns the integral of a density over the hemisphere, by the midpoint rule in cos and phi.
double integral(const Density& density) {
    constexpr int rows = 300, columns = 300;
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
        for (int k = 0; k < columns; ++k) {
            const double z = (i + 0.5) / rows, r = std::sqrt(1 - z * z), phi = 2 * pi * (k + 0.5) / columns;
            sum += density.at({r * std::cos(phi), r * std::sin(phi), z});
        }
    }
    return sum * 2 * pi / (rows * columns);
}

TEST(Density, ExistsOnASurfaceWithoutAlpha) {
    const Experiment e = test::small_scene();
    for (const char* arm : {"uniform", "cosine", "phong", "mixture"})
        EXPECT_NEAR(integral(Density(e, arm, e.s(), 0.2)), 1, 0.02) << arm;
    for (const char* arm : {"blinn", "ggx-d", "ggx-vndf"}) {  // some of their draws are below the horizon
        EXPECT_GT(integral(Density(e, arm, e.s(), 0.2)), 0.8) << arm;
        EXPECT_LT(integral(Density(e, arm, e.s(), 0.2)), 1.001) << arm;
    }
}

TEST(Density, LightArmsAreEvaluatedAtALitPixel) {
    Experiment e = test::small_scene();
    for (const char* arm : {"light-area", "light-solid-angle"}) {
        const Density density(e, arm, e.s(), 0.5);
        EXPECT_NE(density.where(), "") << arm;
        EXPECT_NEAR(density.tilt(), 0.5, 0.2) << arm;
        EXPECT_NEAR(integral(density), 1, 0.15) << arm;
        double largest = 0;
        for (int i = 0; i < 900; ++i) largest = std::max(largest, density.in_plane((i - 450) * pi / 900));
        EXPECT_GT(largest, 0) << arm << ": no light near the plane of incidence";
        EXPECT_LE(largest, 1.01 * density.peak()) << arm;
    }
    e.disks.clear();
    e.lights.clear();
    EXPECT_EQ(Density(e, "light-area", e.s(), 0.5).peak(), 0);
}

TEST(Density, HasALogarithmicScaleUnderASkyWithASun) {
    Experiment e = test::small_scene();
    e.disks.clear();
    e.fill = {};
    for (const char* arm : {"phong", "ggx-d"}) EXPECT_EQ(Density(e, arm, e.s(), 0.5).scale().decades, 0) << arm;
    e.sky = test::constant_sky(1, 1, 1);
    EXPECT_EQ(Density(e, "sky", e.s(), 0.5).scale().decades, 0);
    std::vector<float> texels(3 * 64 * 32, 1);
    for (std::size_t c = 0; c < 3; ++c) texels[3 * (10 * 64 + 20) + c] = 1e5f;
    e.sky = test::sky_of(64, std::move(texels));
    const DensityScale scale = Density(e, "sky", e.s(), 0.5).scale();
    EXPECT_EQ(scale.decades, 5);
    EXPECT_DOUBLE_EQ(scale.share(scale.top), 1);
    EXPECT_NEAR(scale.share(scale.top * 1e-2), 0.6, 1e-12);
    EXPECT_EQ(scale.share(0), 0);
}

TEST(Density, UsesTheShapeOfTheExperimentsExponent) {
    Experiment e = test::small_scene();
    Shape other = e.shapes[0];
    other.name = "other";
    other.material.alpha = 0.9;
    e.shapes.push_back(other);
    e.exponent.emplace();
    e.s_of = e.exponent->shape = "other";
    const Density as_other(e, "ggx-d", e.s(), 0);
    e.s_of = e.exponent->shape = e.shapes[0].name;
    EXPECT_GT(Density(e, "ggx-d", e.s(), 0).in_plane(0), 5 * as_other.in_plane(0));
}

TEST(Density, UsesTheFirstLobeOfASceneWithoutAnExponent) {
    Experiment e = test::small_scene();
    for (Shape& shape : e.shapes) shape.material.s.reset();
    Material& material = e.shapes[0].material;
    material.rho_s = 0.5;
    material.brdf = lobe_named("ggx");
    material.alpha = 0.1;
    const Density smooth(e, "ggx-d", e.s(), 0);
    material.alpha = 0.9;
    EXPECT_GT(smooth.in_plane(0), 5 * Density(e, "ggx-d", e.s(), 0).in_plane(0));
}

}  // namespace charts_test
}  // namespace crescent::plates
