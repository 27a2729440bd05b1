// Films are compared by their hashes, on a scene of 67 x 45 pixels, which is not a multiple of the pack or tile size.
#include "render/estimator.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "tests/support/test_scene.h"

namespace crescent {
namespace estimator_test {

using test::all_arms;

std::vector<std::string> hashes(const std::vector<Film>& films) {
    std::vector<std::string> out;
    for (const Film& film : films) out.push_back(hash(film));
    return out;
}

TEST(SameBits, EveryArmOnEveryInstructionSet) {
    const Scene scene(test::small_scene());
    ProgressMonitor monitor;
    for (const std::string& arm : all_arms()) {
        const auto scalar = hashes(estimate_films(scene, arm, {1, 7, 20}, 3, "scalar", monitor));
        for (const std::string& isa : isas())
            EXPECT_EQ(hashes(estimate_films(scene, arm, {1, 7, 20}, 3, isa, monitor)), scalar) << arm << " on " << isa;
    }
}

TEST(SameBits, EveryLobeOnEveryInstructionSet) {
    ProgressMonitor monitor;
    for (const LobeInfo& lobe : lobe_infos()) {
        const Scene scene(
            test::small_scene({"shapes.ball.brdf=\"" + std::string(lobe.name) + "\"", "shapes.ball.alpha=0.3"}));
        const std::string arm(lobe.own_arm);
        const auto scalar = hashes(estimate_films(scene, arm, {7, 20}, 3, "scalar", monitor));
        for (const std::string& isa : isas())
            EXPECT_EQ(hashes(estimate_films(scene, arm, {7, 20}, 3, isa, monitor)), scalar)
                << lobe.name << " on " << isa;
    }
}

TEST(SameBits, AnyNumberOfThreadsGivesTheSameFilms) {
    const Scene scene(test::small_scene());
    ProgressMonitor monitor;
    const auto want = hashes(estimate_films(scene, "phong", {33}, 3, "", monitor));
    for (std::size_t threads : {1u, 2u, 3u, 16u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(hashes(estimate_films(scene, "phong", {33}, 3, "", monitor)), want) << threads << " threads";
    }
}

TEST(SameBits, NoticesAnotherSeedAndAnotherSampleCount) {
    const Scene scene(test::small_scene());
    ProgressMonitor monitor;
    const auto want = hashes(estimate_films(scene, "cosine", {32}, 3, "", monitor));
    EXPECT_NE(hashes(estimate_films(scene, "cosine", {32}, 4, "", monitor)), want);
    EXPECT_NE(hashes(estimate_films(scene, "cosine", {31}, 3, "", monitor)), want);
}

TEST(Ladder, ARungIsAPrefixWhateverTheOtherRungs) {
    const Scene scene(test::small_scene());
    ProgressMonitor monitor;
    const auto many = estimate_films(scene, "phong", {1, 3, 16, 37, 64}, 9, "", monitor);
    for (const Film& film : many)
        EXPECT_EQ(hash(estimate_films(scene, "phong", {film.n}, 9, "", monitor)[0]), hash(film)) << "n = " << film.n;
}

/// The samples of every shading point of the test scene are compared with the moments that the kernel computed from
/// them.
TEST(Moments, MatchTheSamplesAtManySamples) {
    const Scene scene(test::small_scene());
    constexpr std::uint64_t n = 65536;
    for (ShadingPoints shading_points : shading_points_of(scene, {30, 20, 34, 23}, nullptr)) {
        std::vector<float> x(shading_points.count * n);
        const Moments m = estimate_points(shading_points, "cosine", n, 5, "", nullptr, x.data());
        for (std::size_t i = 0; i < shading_points.count; ++i) {
            float largest = 0;
            for (std::uint64_t j = 0; j < n; ++j) largest = std::max(largest, x[i * n + j]);
            EXPECT_NEAR(m.spread[i] / test::spread_of({x.data() + i * n, n}), 1, 1e-6);
            EXPECT_EQ(m.largest[i], largest);
        }
    }
}

TEST(BadSamples, MinusZeroIsNone) {
    const Scene scene(test::small_scene({"fill.radiance=[-0.0,-0.0,-0.0]", "shapes.ground.rho_d=[-0.0,-0.0,-0.0]",
        "disks.left.radiance=[-0.0,-0.0,-0.0]"}));
    ProgressMonitor monitor;
    for (const std::string& arm : all_arms())
        EXPECT_EQ(estimate_films(scene, arm, {4}, 1, "", monitor)[0].invalid, 0u) << arm;
}

TEST(Shares, OfDirectionsAreNeverAboveOneForAnyArm) {
    const Scene scene(test::small_scene());
    ProgressMonitor monitor;
    std::uint64_t above_n = 0;
    for (const std::string& arm : all_arms()) {
        const Film film = estimate_films(scene, arm, {32}, 2, "", monitor)[0];
        EXPECT_EQ(film.directions, arm.starts_with("mis-") ? 2u : 1u) << arm;
        for (std::size_t at = 0; at < film.size(); ++at) {
            ASSERT_LE(film.horizon[at], film.n * film.directions) << arm;
            ASSERT_LE(film.light_hits[at], film.n * film.directions) << arm;
            ASSERT_LE(film.horizon[at] + film.light_hits[at], film.n * film.directions) << arm;
            above_n += film.light_hits[at] > film.n;
        }
    }
    EXPECT_GT(above_n, 0u);  // a pair of directions may meet a light twice
}

TEST(Films, VarianceIsNaNForNaNAndZeroForZeros) {
    const Scene scene(test::small_scene());
    const ShadingPoints shading_points = shading_points_of(scene, {30, 20, 34, 23}, nullptr).front();
    Moments moments;
    moments.resize(shading_points);
    moments.spread[0] = moments.g[0] = std::nan("");
    moments.bad[0] = 1;
    Film film(67, 45, 8);
    resolve_film(scene, shading_points, moments, film);
    EXPECT_TRUE(std::isnan(film.var[shading_points.pixel[0]]));
    EXPECT_EQ(film.var[shading_points.pixel[1]], 0);
}

TEST(Estimator, StopsWhenAsked) {
    const Scene scene(test::small_scene());
    ProgressMonitor monitor;
    monitor.stop = true;
    EXPECT_THROW(estimate_films(scene, "cosine", {1u << 24}, 1, "", monitor), Interrupted);
}

/// Requests a stop from another thread shortly after the work has begun, as a signal does.
TEST(Estimator, StopsInMidWorkWithinATile) {
    const Scene scene(test::small_scene());
    ProgressMonitor monitor;
    std::atomic<bool> done = false;
    std::thread other([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        EXPECT_FALSE(done);  // 5e10 samples take minutes
        monitor.stop = true;
    });
    EXPECT_THROW(estimate_films(scene, "cosine", {1u << 24}, 1, "", monitor), Interrupted);
    done = true;
    other.join();
}

TEST(LargestSamples, MatchTheSamplesInDescendingOrder) {
    const Scene scene(test::small_scene());
    ProgressMonitor monitor;
    constexpr std::uint64_t n = 40;
    const Box box = {0, 0, scene.image().width - 1, scene.image().height - 1};  // many tiles
    for (const int surface : {any_surface, 0}) {
        std::vector<float> all;
        for (const ShadingPoints& shading_points :
            shading_points_of(scene, {box.x0, box.y0, box.x1 + 1, box.y1 + 1}, nullptr)) {
            std::vector<float> x(shading_points.count * n);
            estimate_points(shading_points, "phong", n, 4, "", nullptr, x.data());
            for (std::size_t k = 0; k < x.size(); ++k)
                if (surface == any_surface || static_cast<int>(shading_points.shape[k / n]) == surface)
                    all.push_back(x[k]);
        }
        std::sort(all.begin(), all.end(), std::greater<>());
        std::uint64_t drawn = 0;
        const std::vector<float> largest =
            largest_samples(scene, "phong", n, 4, {box, surface}, 100, "", monitor, drawn);
        EXPECT_EQ(drawn, all.size());
        all.resize(100);
        EXPECT_EQ(largest, all);
    }
}

TEST(InstructionSets, UnknownNameSuggestsTheNearest) {
    try {
        kernels_for("avx3");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("avx2"), std::string::npos) << error.what();
    }
}

}  // namespace estimator_test
}  // namespace crescent
