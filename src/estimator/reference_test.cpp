// The quadrature reference against a Monte Carlo one that shares nothing with it, over scenes drawn at random.
#include "estimator/reference.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/sanitized_test.h"
#include "estimator/oracle_test.h"
#include "estimator/random_scene_test.h"

namespace crescent::inline estimator {
namespace {

constexpr std::uint32_t scenes_a_shard = test::sanitized ? 8 : 40;
constexpr std::uint32_t shards = 8;
constexpr int draws = 1500;

/// The reference less the truth over some pixels, and by how much the two may differ.
struct Comparison {
    double apart = 0, stated = 0, variance = 0, largest = 0;
    void add(const Comparison& other) {
        apart += other.apart, stated += other.stated, variance += other.variance;
        largest = std::max(largest, other.largest);
    }
    /// A draw in a thousand may be worth more than all others: what was not drawn may be as large as the largest few.
    bool agree() const { return std::fabs(apart) <= stated + 5 * std::sqrt(variance) + 20 * largest; }
};

Comparison compare_pixel(
    const Scene& scene, const ReferenceFilm& film, const Hit& hit, std::size_t at, std::uint32_t seed) {
    const test::Opinion truth = test::Oracle(scene, hit, seed)(draws);
    const double rounding = 1e-6 * truth.y;  // films are floats
    return {static_cast<double>(film.y[at]) - truth.y, static_cast<double>(film.error[at]) + rounding, truth.variance,
        truth.largest};
}

class ReferenceOfRandomScenes : public testing::TestWithParam<std::uint32_t> {};

/// Scenes of one shard, `newcomers` as RandomScene has it.
void compare_scenes(std::uint32_t shard, std::uint32_t count, bool newcomers) {
    ProgressMonitor watch;
    for (std::uint32_t seed = 1000 * shard; seed < 1000 * shard + count; ++seed) {
        test::RandomScene draw(seed, newcomers);
        const Scene scene(draw());
        const ReferenceFilm film = quadrature_reference(scene, {scene.s()}, watch)[0];
        Comparison all;
        std::string off;
        for (int j = 0; j < film.height; ++j)
            for (int i = 0; i < film.width; ++i) {
                const auto hit = scene.primary(i, j);
                if (!hit) continue;
                const auto at = static_cast<std::size_t>(j * film.width + i);
                const Comparison one =
                    compare_pixel(scene, film, *hit, at, 100 * seed + static_cast<std::uint32_t>(at));
                if (!one.agree())
                    off += fmt::format(
                        " ({}, {}): {:.3g} of {:.3g}, stated {:.2g};", i, j, one.apart, film.y[at], one.stated);
                all.add(one);
            }
        EXPECT_TRUE(off.empty() && all.agree()) << "scene " << seed << off << " all: " << all.apart << "\n"
                                                << draw.what;
    }
}

TEST_P(ReferenceOfRandomScenes, IsTheTruthWithinItsStatedError) { compare_scenes(GetParam(), scenes_a_shard, false); }

TEST_P(ReferenceOfRandomScenes, IsTheTruthOfBallsAndRectanglesToo) {
    compare_scenes(GetParam(), scenes_a_shard / 2, true);
}

INSTANTIATE_TEST_SUITE_P(Shards, ReferenceOfRandomScenes, testing::Range(0u, shards));

}  // namespace
}  // namespace crescent::inline estimator
