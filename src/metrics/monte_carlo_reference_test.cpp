// Against the quadrature over a whole image, in standard errors; and its random numbers against those of the arms.
#include "metrics/monte_carlo_reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/simd/random.h"
#include "render/estimator.h"
#include "render/reference/reference.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace monte_carlo_reference_test {

/// Returns the standard errors between the two references, over the whole image.
double references_apart(const Experiment& experiment) {
    const Scene scene(experiment);
    ProgressMonitor monitor;
    const ReferenceFilm q = quadrature_reference(scene, {experiment.s()}, monitor)[0],
                        note = monte_carlo_reference({scene}, experiment, "", monitor)[0];
    double difference = 0, variance = 0;
    for (std::size_t at = 0; at < q.size(); ++at) {
        difference += static_cast<double>(note.y[at]) - static_cast<double>(q.y[at]);
        variance += static_cast<double>(note.error[at]) * static_cast<double>(note.error[at]);
    }
    return std::fabs(difference) / std::sqrt(variance);
}

TEST(Estimator, ArticleReferenceMatchesTheQuadrature) { EXPECT_LT(references_apart(test::small_scene()), 4); }

TEST(Estimator, DiskBehindAnotherIsHiddenFromBoth) {
    Experiment experiment = test::small_scene();
    DiskLight& near = experiment.disks[0];
    DiskLight& far = experiment.disks[1];
    near.center = {0, 2, 0};
    near.normal = {0, -1, 0};
    near.radius = 0.5;
    near.radiance = {5, 5, 5};
    far.center = {0, 3, 0};
    far.normal = {0, -1, 0};
    far.radius = 0.6;
    far.radiance = {50, 50, 50};
    EXPECT_LT(references_apart(experiment), 4);
    Experiment alone = experiment;
    alone.disks.erase(alone.disks.begin());
    ProgressMonitor monitor;
    const Scene both(experiment), bare(alone);
    const ReferenceFilm with = quadrature_reference(both, {both.s()}, monitor)[0];
    const ReferenceFilm without = quadrature_reference(bare, {bare.s()}, monitor)[0];
    int darker = 0;  // ten times less radiant than what it hides
    for (std::size_t at = 0; at < with.size(); ++at) darker += with.y[at] < 0.7f * without.y[at];
    EXPECT_GT(darker, 100);
}

/// Returns the correlation of the errors of two films, over the pixels that see a shape.
double correlation(const std::vector<float>& a, const std::vector<float>& b, const std::vector<float>& truth) {
    double aa = 0, bb = 0, ab = 0;
    for (std::size_t at = 0; at < truth.size(); ++at) {
        const double x = static_cast<double>(a[at] - truth[at]), y = static_cast<double>(b[at] - truth[at]);
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

TEST(Estimator, ArticleReferenceSharesNoRandomStream) {
    Experiment experiment = test::small_scene();
    experiment.seed = experiment.reference.seed = 1;
    experiment.seeds = 4;
    const Scene scene(experiment);
    ProgressMonitor monitor;
    const std::vector<double> s = {experiment.s()};
    const ReferenceFilm truth = quadrature_reference(scene, s, monitor)[0],
                        note = monte_carlo_reference({scene}, experiment, "", monitor)[0];
    for (std::uint32_t k = 0; k < 4; ++k)
        for (const char* arm : {"phong", "light-area"}) {
            const Film film = estimate_films(scene, arm, {96}, seed_of(1, k), "", monitor)[0];
            EXPECT_LT(std::fabs(correlation(note.y, film.y, truth.y)), 0.15) << arm << ", seed " << k;
        }
    for (std::uint32_t k = 0; k < 64; ++k)
        for (std::uint32_t a = 0; a < 4; ++a) EXPECT_NE(reference_seed(experiment, k), seed_of(experiment.seed, a));
}

}  // namespace monte_carlo_reference_test
}  // namespace crescent
