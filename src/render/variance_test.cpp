// The variance of a film against the two-pass variance of its samples, for every sampler: where samples hardly differ
// (small area lights) and where they differ by orders of magnitude (a sampler that fits badly).
#include <gtest/gtest.h>

#include <cmath>

#include "render/estimator.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace variance_test {

/// Returns the test scene with area lights of another size and the same radiance.
Scene scene_with_area_lights(double radius) {
    Experiment e = test::small_scene();
    for (DiskLight& disk : e.disks) {
        const double share = sqr(disk.radius / radius);
        disk.radius = radius;
        for (double& c : disk.radiance) c = std::min(c * share, 1e9);
    }
    return Scene(e);
}

/// Pixels of the block and its shadow, of the ball's side, and of the ground at the horizon.
constexpr TileBox boxes[] = {{30, 8, 34, 10}, {24, 24, 28, 26}, {0, 31, 67, 32}};

/// The smallest variance at which all values are normal floats.
constexpr double least = 1e-37;

void expect_two_pass(const ShadingPoints& shading_points, const std::string& arm, std::uint64_t n, double radius) {
    std::vector<float> x(shading_points.count * n);
    const Moments m = estimate_points(shading_points, arm, n, 5, "", nullptr, x.data());
    for (std::size_t i = 0; i < shading_points.count; ++i) {
        const double want = test::spread_of({x.data() + i * n, n});
        EXPECT_NEAR(m.spread[i], want, 1e-4 * want + least)
            << arm << ", n = " << n << ", lamps of " << radius << " m, pixel " << shading_points.pixel[i];
    }
}

TEST(VarianceConformance, EveryArmHasItsTwoPassVariance) {
    for (const double radius : {0.3, 1e-2, 1e-3, 1e-4, 1e-5}) {
        const Scene scene = scene_with_area_lights(radius);
        for (const TileBox& box : boxes)
            for (const ShadingPoints& shading_points : shading_points_of(scene, box, nullptr))
                for (const std::string& arm : test::all_arms())
                    for (const std::uint64_t n : {2, 5, 16, 17, 64, 1000})
                        expect_two_pass(shading_points, arm, n, radius);
    }
}

TEST(VarianceConformance, AFilmShowsIt) {
    const Scene scene = scene_with_area_lights(1e-3);
    ProgressMonitor monitor;
    const TileBox box = {30, 8, 34, 10};
    const ShadingPoints shading_points = shading_points_of(scene, box, nullptr).front();
    std::vector<float> x(shading_points.count * 64);
    estimate_points(shading_points, "light-area", 64, 5, "", nullptr, x.data());
    const Film film = estimate_films(scene, "light-area", {64}, 5, "", monitor)[0];
    for (std::size_t i = 0; i < shading_points.count; ++i) {
        const double want = test::spread_of({x.data() + i * 64, 64}) / (64 * 63);
        EXPECT_NEAR(static_cast<double>(film.var[shading_points.pixel[i]]), want, 1e-4 * want) << i;
    }
}

TEST(VarianceConformance, SamplesThatAreAllAlikeHaveNone) {
    Experiment e = test::small_scene();
    e.disks.clear();
    const Scene scene(e);
    ProgressMonitor monitor;
    const Film film = estimate_films(scene, "light-area", {100}, 1, "", monitor)[0];  // no light: every X is 0
    for (const float v : film.var) EXPECT_EQ(v, 0);
}

}  // namespace variance_test
}  // namespace crescent
