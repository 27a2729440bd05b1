// Balls of light that bodies and other lights reach into: the reference knows what is hidden of them, and does not
// merely doubt it; and balls of up to 1e6 m, whose nearest point is 1 m away, in single precision.
#include <gtest/gtest.h>

#include <cmath>

#include "estimator/estimator.h"
#include "reference/oracle_test.h"
#include "reference/reference.h"
#include "estimator/test_scene.h"

namespace crescent::inline reference {
namespace {

/// A floor under a ball of light of radius 0.5 m, 1 m above it.
Experiment under_a_ball() {
    Experiment e = test::small_scene();
    e.image = {3, 2}, e.fill = {};
    e.shapes.resize(1);
    e.shapes[0].form = shapes::Plane{{0, 0, 0}, {0, 1, 0}};
    e.camera.eye = {0.3, 2, 3}, e.camera.target = {0, 0, 0}, e.camera.vfov_deg = 10;
    e.disks.clear();
    e.lights.push_back({"ball", lights::Sphere{{0, 1.5, 0}, 0.5}, {10, 10, 10}, {}});
    return e;
}

/// In sums over the pixels: the reference is the oracle's truth, and says that it knows it to `doubt`, relative.
void expect_known(const Experiment& e, double doubt, const std::string& what) {
    const Scene scene(e);
    ProgressMonitor monitor;
    const ReferenceFilm film = quadrature_reference(scene, {scene.s()}, monitor)[0];
    double y = 0, stated = 0, truth = 0, variance = 0;
    for (int j = 0; j < film.height; ++j)
        for (int i = 0; i < film.width; ++i) {
            const auto hit = scene.primary(i, j);
            ASSERT_TRUE(hit);
            const auto at = static_cast<std::size_t>(j * film.width + i);
            const test::Opinion opinion = test::Oracle(scene, *hit, static_cast<std::uint32_t>(at))(20'000);
            y += static_cast<double>(film.y[at]), stated += static_cast<double>(film.error[at]);
            truth += opinion.y, variance += opinion.variance;
        }
    EXPECT_NEAR(y, truth, stated + 5 * std::sqrt(variance)) << what;
    EXPECT_LE(stated, doubt * truth) << what;
}

Shape body(const shapes::Quad& quad) {
    Shape s;
    s.name = "shelf", s.form = quad, s.occludes = true, s.material.rho_d = {0.3, 0.3, 0.3}, s.material.s = 10;
    return s;
}

TEST(BallLights, ThatAShelfCutsAreKnown) {
    for (const double height : {1.05, 1.2, 1.3, 1.4}) {
        Experiment e = under_a_ball();
        e.shapes.push_back(body({{-2, height, -2}, {0, 0, 4}, {4, 0, 0}}));
        expect_known(e, 0.15, "a shelf at " + std::to_string(height));
        e.shapes.back().form = shapes::Quad{{-2, height, 0.1}, {0, 0, 4}, {4, 0, 0.3}};
        expect_known(e, 0.1, "half a shelf at " + std::to_string(height));
    }
}

TEST(BallLights, ThatOtherLightsCutAreKnown) {
    Experiment e = under_a_ball();
    e.lights.push_back({"sheet", lights::Rectangle{{-1, 1.2, -1}, {2, 0, 0}, {0, 0, 2}, true}, {1, 1, 1}, {}});
    expect_known(e, 0.1, "a bright ball in a sheet of light");
    e.lights[0].radiance = {1, 1, 1}, e.lights[1].radiance = {10, 10, 10};
    expect_known(e, 0.1, "a dim ball in a sheet of light");
    e.lights[1].form = lights::Sphere{{0.4, 1.4, 0.2}, 0.45};
    expect_known(e, 0.1, "two balls in one another");
}

TEST(BallLights, OfAnySizeShineAlikeOnEveryArm) {
    for (const double radius : {0.1, 10.0, 1e3, 1e6}) {
        Experiment e = under_a_ball();
        e.lights[0].form = lights::Sphere{{0, radius + 1, 0}, radius};
        const Scene scene(e);
        ProgressMonitor monitor;
        const ReferenceFilm reference = quadrature_reference(scene, {scene.s()}, monitor)[0];
        for (const char* arm : {"light-area", "light-solid-angle", "cosine", "mis-balance"}) {
            const Film film = estimate_films(scene, arm, {16384}, 3, "", monitor)[0];
            double y = 0, truth = 0, doubt = 0, variance = 0;
            for (std::size_t at = 0; at < film.y.size(); ++at) {
                y += static_cast<double>(film.y[at]), variance += static_cast<double>(film.var[at]);
                truth += static_cast<double>(reference.y[at]), doubt += static_cast<double>(reference.error[at]);
            }
            EXPECT_NEAR(y, truth, doubt + 5 * std::sqrt(variance) + 1e-5 * truth) << arm << ", " << radius << " m";
        }
    }
}

}  // namespace
}  // namespace crescent::inline reference
