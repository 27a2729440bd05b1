// The quadrature reference over random scenes: against an independent Monte Carlo one, and against the films of arms.
#include "render/reference/reference.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/oracle.h"
#include "tests/support/random_scene.h"
#include "tests/support/samplers_at_point.h"
#include "tests/support/sanitized.h"

namespace crescent {
namespace reference_test {

constexpr std::uint32_t scenes_a_shard = test::sanitized ? 5 : 15;
constexpr std::uint32_t shards = 8, brighter_scenes = test::sanitized ? 8 : 20;
constexpr int draws = 1500;

/// The difference of the reference from the truth over some pixels, and the allowed difference.
struct Comparison {
    double apart = 0, stated = 0, variance = 0, largest = 0;
    void add(const Comparison& other) {
        apart += other.apart;
        stated += other.stated;
        variance += other.variance;
        largest = std::max(largest, other.largest);
    }
    /// A draw in a thousand may be larger than all others: the part not drawn may be as large as the largest few.
    bool agree() const { return std::fabs(apart) <= stated + 5 * std::sqrt(variance) + 20 * largest; }
};

Comparison compare_pixel(
    const Scene& scene, const ReferenceFilm& film, const Hit& hit, std::size_t at, std::uint32_t seed) {
    const test::Opinion truth = test::Oracle(scene, hit, seed)(draws);
    const double rounding = 1e-6 * truth.y;  // films are floats
    return {static_cast<double>(film.y[at]) - truth.y, static_cast<double>(film.error[at]) + rounding, truth.variance,
        truth.largest};
}

/// Returns what differs from the truth, pixel by pixel and in total; empty if nothing does.
std::string differences(const Scene& scene, const ReferenceFilm& film, std::uint32_t seed) {
    Comparison all;
    std::string off;
    for (int j = 0; j < film.height; ++j)
        for (int i = 0; i < film.width; ++i) {
            const auto hit = scene.primary(i, j);
            if (!hit) continue;
            const auto at = static_cast<std::size_t>(j * film.width + i);
            const Comparison one = compare_pixel(scene, film, *hit, at, 100 * seed + static_cast<std::uint32_t>(at));
            if (!one.agree())
                off +=
                    fmt::format(" ({}, {}): {:.3g} of {:.3g}, stated {:.2g};", i, j, one.apart, film.y[at], one.stated);
            all.add(one);
        }
    return off.empty() && all.agree() ? "" : off + fmt::format(" all: {:.3g}", all.apart);
}

/// Every third scene has a spherical or rectangular light, every third has bodies of up to 1e6 m and is far away.
test::RandomScene scene_drawn(std::uint32_t seed) { return test::RandomScene(seed, seed % 3 != 0, seed % 3 == 2); }

class ReferenceOfRandomScenes : public testing::TestWithParam<std::uint32_t> {};

TEST_P(ReferenceOfRandomScenes, MatchesOracleAndArmsWithinErrors) {
    ProgressMonitor monitor;
    int known = 0, pixels = 0;
    const std::uint32_t first = 1000 * GetParam();
    for (std::uint32_t seed = first; seed < first + scenes_a_shard; ++seed) {
        test::RandomScene draw = scene_drawn(seed);
        const Scene scene(draw());
        const ReferenceFilm film = quadrature_reference(scene, {scene.s()}, monitor)[0];
        EXPECT_EQ(differences(scene, film, seed), "") << "scene " << seed << "\n" << draw.what;
        const test::Compared arms = test::compare_scene(scene, film, seed);
        EXPECT_EQ(arms.off, 0) << "scene " << seed << arms.describe << "\n" << draw.what;
        known += arms.known;
        pixels += arms.pixels;
    }
    EXPECT_GT(known, pixels / 2);
}

INSTANTIATE_TEST_SUITE_P(Shards, ReferenceOfRandomScenes, testing::Range(0u, shards));

/// Exponents of a pixel share visibility: it does not change another exponent's film.
TEST(ReferencesOfManyExponents, AreThoseOfEachAlone) {
    ProgressMonitor monitor;
    const std::vector<double> exponents = {3, 700};
    for (std::uint32_t seed = 9000; seed < 9003; ++seed) {
        test::RandomScene draw = scene_drawn(seed);
        const Scene scene(draw());
        const std::vector<ReferenceFilm> all = quadrature_reference(scene, exponents, monitor);
        for (std::size_t e = 0; e < exponents.size(); ++e)
            EXPECT_EQ(hash(all[e]), hash(quadrature_reference(scene, {exponents[e]}, monitor)[0]))
                << "scene " << seed << ", s " << exponents[e] << "\n"
                << draw.what;
    }
}

/// A reference of area lights that are 15 % brighter than the scene's is detected wherever the arms have low variance.
TEST(ReferencesOfOtherScenes, DisagreeWithTheArms) {
    ProgressMonitor monitor;
    int lit = 0, found = 0;
    for (std::uint32_t seed = 7000; seed < 7000 + brighter_scenes; ++seed) {
        Experiment e = scene_drawn(seed)();
        e.fill = {};
        const Scene scene(e);
        for (DiskLight& disk : e.disks)
            for (double& c : disk.radiance) c *= 1.15;
        for (Light& light : e.lights)
            for (double& c : light.radiance) c *= 1.15;
        const ReferenceFilm wrong = quadrature_reference(Scene(e), {scene.s()}, monitor)[0];
        const test::Compared all = test::compare_scene(scene, wrong, seed);
        if (all.known == 0) continue;
        double y = 0, stated = 0;
        for (std::size_t at = 0; at < wrong.y.size(); ++at) {
            y += static_cast<double>(wrong.y[at]);
            stated += static_cast<double>(wrong.error[at]);
        }
        if (!(stated < 0.005 * y)) continue;
        ++lit;
        found += all.off > 0;
    }
    EXPECT_GE(10 * found, 9 * lit) << found << " of " << lit;
    EXPECT_GE(lit, static_cast<int>(brighter_scenes) / 8);
}

/// Arms that reach all light agree with the quadrature within their own standard error, over the whole image.
TEST(Estimator, UnbiasedArmsMeetTheQuadrature) {
    const Experiment experiment = test::small_scene();
    const Scene scene(experiment);
    ProgressMonitor monitor;
    const ReferenceFilm reference = quadrature_reference(scene, {experiment.s()}, monitor)[0];
    for (const char* arm : {"uniform", "cosine", "mixture", "mis-balance",
             "mis-power"}) {  // lights_test.cpp has those that aim at area lights
        const Film film = estimate_films(scene, arm, {1024}, 17, "", monitor)[0];
        double difference = 0, variance = 0;
        for (std::size_t at = 0; at < film.size(); ++at) {
            difference += static_cast<double>(film.y[at]) - static_cast<double>(reference.y[at]);
            variance += static_cast<double>(film.var[at]);
        }
        EXPECT_LT(std::fabs(difference), 4 * std::sqrt(variance)) << arm;
    }
}

}  // namespace reference_test
}  // namespace crescent
