// Lamps down to the smallest that the schema permits, and scenes as far from (0, 0, 0) as it permits: every arm that is
// right there has the reference's mean, within its own doubt and that of the reference.
#include <gtest/gtest.h>

#include <cmath>

#include "estimator/estimator.h"
#include "reference/reference.h"
#include "estimator/test_scene.h"

namespace crescent::inline reference {
namespace {

/// The test scene without fill, its lamps of another size and moved.
Experiment lamps(double radius, double offset, const std::vector<std::string>& overrides = {}) {
    Experiment e = test::small_scene(overrides);
    e.image = {32, 22};
    e.fill = {};
    for (DiskLight& disk : e.disks) disk.radius = radius;
    e.disks[0].center = {-1.5, 3.5, 1.0}, e.disks[1].center = {3, 3, 2};  // a lamp of 1 m clears ball, block and ground
    test::shift(e, {offset, -0.5 * offset, offset / 3});
    return e;
}

/// Films are single precision, and sums of 16 samples: 1e-6 of each pixel.
constexpr double film_error = 1e-6;

void expect_mean(const Scene& scene, const ReferenceFilm& reference, const std::string& arm, std::uint64_t n,
    const std::string& what) {
    ProgressMonitor monitor;
    const Film film = estimate_films(scene, arm, {n}, 17, "", monitor)[0];
    double difference = 0, variance = 0, stated = 0;
    for (std::size_t at = 0; at < film.size(); ++at) {
        difference += static_cast<double>(film.y[at]) - static_cast<double>(reference.y[at]);
        variance += static_cast<double>(film.var[at]);
        stated += static_cast<double>(reference.error[at]) + film_error * static_cast<double>(reference.y[at]);
    }
    EXPECT_LE(std::fabs(difference), 5 * std::sqrt(variance) + stated) << arm << ", " << what;
    EXPECT_EQ(film.invalid, 0u) << arm << ", " << what;
}

void expect_means(const Experiment& e, const std::vector<std::string>& arms, std::uint64_t n, const std::string& what) {
    const Scene scene(e);
    ProgressMonitor monitor;
    const ReferenceFilm reference = quadrature_reference(scene, {e.s()}, monitor)[0];
    for (const std::string& arm : arms) expect_mean(scene, reference, arm, n, what);
}

const std::vector<std::string> aiming = {"light-area", "light-solid-angle", "mis-balance", "mis-power"};
const std::vector<std::string> reaching = {
    "uniform", "cosine", "mixture"};  // whose hits are too few where a lamp is small

class LampLaw : public testing::TestWithParam<double> {};

TEST_P(LampLaw, EveryArmThatIsRightHasTheReferencesMeanWhereverTheSceneStands) {
    const double radius = GetParam();
    for (const double offset : {0.0, 1e3, 1e5, 1e6}) {
        const std::string what = "radius " + std::to_string(radius) + " m, moved by " + std::to_string(offset) + " m";
        const Experiment e = lamps(radius, offset);
        expect_means(e, aiming, 256, what);
        if (radius >= 0.1) expect_means(e, reaching, 1024, what);
    }
}

INSTANTIATE_TEST_SUITE_P(Radii, LampLaw, testing::Values(1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6));

TEST(Lamps, TheirSizeChangesNoMoreThanTheirLight) {
    const auto irradiance = [](double radius, const std::string& arm) {  // per area of lamp
        const Scene scene(lamps(radius, 0));
        ProgressMonitor monitor;
        const Film film = estimate_films(scene, arm, {64}, 3, "", monitor)[0];
        double sum = 0;
        for (const float y : film.y) sum += static_cast<double>(y);
        return sum / sqr(radius);
    };
    for (const std::string& arm : aiming) EXPECT_NEAR(irradiance(1e-6, arm) / irradiance(1e-4, arm), 1, 1e-5) << arm;
}

TEST(Lamps, SixtyFourAreAllCounted) {
    Experiment e = lamps(0.05, 0);
    e.disks.resize(1);
    e.disks[0].radius = 0.05, e.disks[0].normal = {0, -1, 0};
    for (int k = 1; k < 64; ++k) {
        DiskLight disk = e.disks[0];
        disk.name = "lamp" + std::to_string(k);
        disk.center = {0.4 * (k % 8) - 1.4, 3.5, 0.4 * (k / 8) - 1};
        e.disks.push_back(disk);
    }
    ASSERT_EQ(e.disks.size(), most_lights);
    expect_means(e, aiming, 256, "64 lamps");
}

TEST(Lamps, ScenesMayStandAnywhereForABodyInTheirLight) {
    ProgressMonitor monitor;
    const auto film_at = [&](double offset) {
        return estimate_films(Scene(lamps(0.2, offset)), "light-area", {16}, 3, "", monitor)[0];
    };
    const Film here = film_at(0), there = film_at(1e6);
    std::size_t other = 0;
    for (std::size_t at = 0; at < here.size(); ++at) other += std::fabs(here.y[at] - there.y[at]) > 1e-3f * here.y[at];
    EXPECT_LE(other, here.size() / 50);
}

}  // namespace
}  // namespace crescent::inline reference
