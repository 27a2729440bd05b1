// The quadrature reference against the films of arms, over scenes drawn at random. Of all arms each pixel is held
// against the one whose variance there is least, as draws of a double-precision oracle measure it, which meet every
// lobe and every lamp: an arm that misses a peak has a large variance, whatever its own few samples say.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "base/sanitized_test.h"
#include "estimator/estimator.h"
#include "estimator/oracle_test.h"
#include "estimator/pixel.h"
#include "estimator/random_scene_test.h"
#include "estimator/reference.h"

namespace crescent::inline estimator {
namespace {

constexpr std::uint32_t scenes_a_shard = test::sanitized ? 6 : 40;
constexpr std::uint32_t shards = 8, brighter_scenes = test::sanitized ? 8 : 20;
constexpr std::uint64_t samples = 8192;
constexpr int draws = 250;
/// What an arm in single precision may be off, relative: as much as check grants the density of one.
constexpr double single_precision = 1e-4;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Which arm has the least second moment at a pixel, hence the least variance: all have the same mean.
struct Choice {
    std::string arm;
    double moment = infinite;
};

/// int F^2 / p of every arm that has one density, and of mis-balance, whose two act as their sum (Veach & Guibas 1995);
/// F = f L cos. Infinite where p = 0 and F is not.
class SecondMoments {
public:
    SecondMoments(const Scene& scene, const Hit& hit, int i, int j, std::uint32_t seed)
        : pixel_(scene, i, j), oracle_(scene, hit, seed) {
        for (const ArmInfo& arm : arm_infos())
            if (arm.techniques == 1) moments_[std::string(arm.name)] = 0;
        moments_["mis-balance"] = 0;
        for (std::size_t k = 0; k < oracle_.techniques(); ++k)
            for (int n = 0; n < draws; ++n) add(oracle_.draw(k));
    }
    Choice least() const {
        Choice out;
        for (const auto& [arm, moment] : moments_)
            if (moment < out.moment) out = {arm, moment};
        return out;
    }

private:
    void add(const test::Oracle::Direction& drawn) {
        if (!(drawn.density > 0)) return;
        const double F = drawn.worth + oracle_.lambert_under_fill() * drawn.wi.z;
        if (!(F > 0)) return;
        for (auto& [arm, moment] : moments_) {
            const bool pair = arm == "mis-balance";
            const double p = pixel_.pdf(arm, drawn.wi) + (pair ? pixel_.pdf("light-area", drawn.wi) : 0);
            moment += p > 0 ? F / p * F / drawn.density / draws : infinite;
        }
    }
    OpenPixel pixel_;
    test::Oracle oracle_;
    std::map<std::string, double> moments_;
};

/// How the pixels of a scene compare: those that an arm knows to 2 % and those of them that are off.
struct Compared {
    int known = 0, off = 0, pixels = 0;
    std::string told;
};

class ArmsOf {
public:
    explicit ArmsOf(const Scene& scene) : scene_(scene) {}
    const Film& film(const std::string& arm) {
        const auto found = films_.find(arm);
        if (found != films_.end()) return found->second;
        ProgressMonitor watch;
        return films_.emplace(arm, estimate_films(scene_, arm, {samples}, 29, "", watch)[0]).first->second;
    }

private:
    const Scene& scene_;
    std::map<std::string, Film> films_;
};

Compared compare_scene(const Scene& scene, const ReferenceFilm& reference, std::uint32_t seed) {
    Compared out;
    ArmsOf arms(scene);
    for (int j = 0; j < reference.height; ++j)
        for (int i = 0; i < reference.width; ++i) {
            const auto hit = scene.primary(i, j);
            if (!hit) continue;
            ++out.pixels;
            const auto at = static_cast<std::size_t>(j * reference.width + i);
            const double y = static_cast<double>(reference.y[at]), stated = static_cast<double>(reference.error[at]);
            const Choice best = SecondMoments(scene, *hit, i, j, 100 * seed + static_cast<std::uint32_t>(at)).least();
            if (!(best.moment < infinite)) continue;
            const Film& film = arms.film(best.arm);
            const double mean = static_cast<double>(film.y[at]);
            const double variance = std::max(static_cast<double>(film.var[at]),
                std::max(best.moment - mean * mean, 0.0) / static_cast<double>(samples));
            if (std::sqrt(variance) > 0.02 * std::max(mean, y)) continue;
            ++out.known;
            const double allowed = stated + 5 * std::sqrt(variance) + single_precision * y;
            if (std::fabs(y - mean) <= allowed) continue;
            ++out.off;
            out.told += fmt::format(" ({}, {}) {}: reference {:.5g} +- {:.2g}, arm {:.5g} +- {:.2g};", i, j, best.arm,
                y, stated, mean, std::sqrt(variance));
        }
    return out;
}

/// Every third scene has a ball or a rectangle of light, every third bodies of up to 1e6 m and stands far away.
test::RandomScene scene_drawn(std::uint32_t seed) { return test::RandomScene(seed, seed % 3 != 0, seed % 3 == 2); }

class ArmsAndReference : public testing::TestWithParam<std::uint32_t> {};

TEST_P(ArmsAndReference, AgreeOnRandomScenesWithinTheirDoubts) {
    ProgressMonitor watch;
    int known = 0, pixels = 0;
    for (std::uint32_t seed = 7000 + 1000 * GetParam(); seed < 7000 + 1000 * GetParam() + scenes_a_shard; ++seed) {
        test::RandomScene draw = scene_drawn(seed);
        const Scene scene(draw());
        const Compared all = compare_scene(scene, quadrature_reference(scene, {scene.s()}, watch)[0], seed);
        EXPECT_EQ(all.off, 0) << "scene " << seed << all.told << "\n" << draw.what;
        known += all.known, pixels += all.pixels;
    }
    EXPECT_GT(known, pixels / 2);
}

INSTANTIATE_TEST_SUITE_P(Shards, ArmsAndReference, testing::Range(0u, shards));

/// A reference of lamps that are 15 % brighter than the scene's is found out wherever arms know the pixels.
TEST(ArmsAndReferences, ThatAreOfOtherScenesDisagree) {
    ProgressMonitor watch;
    int lit = 0, found = 0;
    for (std::uint32_t seed = 7000; seed < 7000 + brighter_scenes; ++seed) {
        Experiment e = scene_drawn(seed)();
        e.fill = {};
        const Scene scene(e);
        for (DiskLight& disk : e.disks)
            for (double& c : disk.radiance) c *= 1.15;
        for (Light& light : e.lights)
            for (double& c : light.radiance) c *= 1.15;
        const ReferenceFilm wrong = quadrature_reference(Scene(e), {scene.s()}, watch)[0];
        const Compared all = compare_scene(scene, wrong, seed);
        if (all.known == 0) continue;
        double y = 0, stated = 0;
        for (std::size_t at = 0; at < wrong.y.size(); ++at)
            y += static_cast<double>(wrong.y[at]), stated += static_cast<double>(wrong.error[at]);
        if (!(stated < 0.005 * y)) continue;
        ++lit, found += all.off > 0;
    }
    EXPECT_GE(10 * found, 9 * lit) << found << " of " << lit;
    EXPECT_GE(lit, static_cast<int>(brighter_scenes) / 8);
}

}  // namespace
}  // namespace crescent::inline estimator
