// The measurements of a run: sorted by the plan, with provenance, from a part of the jobs as well.
#include "run/collect.h"

#include <gmock/gmock.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "experiment/identity.h"
#include "render/estimator.h"
#include "run/version.h"
#include "tests/support/small_run.h"

namespace crescent {
namespace collect_test {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(Collect, RunsAreInTheOrderOfThePlan) {
    ProgressMonitor monitor;
    const RunPlan all = plan(test::small_experiment({"seeds=1"}));
    Prepared prepared = prepare(all, {}, monitor);
    std::vector<JobResult> results;
    for (const std::size_t k : {2, 0}) results.push_back(execute(all, prepared, all.jobs[k], {}, monitor, k == 2));
    results.emplace_back().job = all.jobs[1];
    results.back().stopped = false;
    results.back().metrics.resize(1);
    results.back().metrics[0].key = {"cosine", 16, 24, 11};
    results.back().metrics[0].regions.resize(1);
    results.back().metrics[0].regions[0].region = "all";
    const Measured out =
        collect(all, std::move(prepared), std::move(results), {}, monitor, {.command = "c", .studies = false});
    EXPECT_FALSE(out.stopped);
    std::vector<std::string> arms;
    for (const RunMetrics& run : out.metrics.runs) arms.push_back(run.key.arm);
    EXPECT_THAT(arms, ElementsAre("uniform", "cosine", "phong", "phong"));
    EXPECT_EQ(out.timing.arms.size(), 3u);
    EXPECT_EQ(out.film({"uniform", 16, 24, 11}), nullptr);
    ASSERT_NE(out.film({"phong", 4, 24, 11}), nullptr);
    EXPECT_EQ(out.film({"phong", 4, 24, 11})->n, 4u);
    EXPECT_EQ(out.metrics.film_hashes.at("phong n=4 s=24"), hash(*out.film({"phong", 4, 24, 11})));
    EXPECT_NE(out.reference(24), nullptr);
    EXPECT_EQ(out.reference(8), nullptr);
    EXPECT_TRUE(out.metrics.furnaces.empty());
}

TEST(Collect, AStoppedJobStopsTheRun) {
    ProgressMonitor monitor;
    const RunPlan all = plan(test::small_experiment({"seeds=1"}));
    Prepared prepared = prepare(all, {}, monitor);
    std::vector<JobResult> results(1);
    results[0].job = all.jobs[0];
    results[0].stopped = true;
    results[0].metrics.resize(1);
    const Measured out =
        collect(all, std::move(prepared), std::move(results), {}, monitor, {.command = "c", .studies = false});
    EXPECT_TRUE(out.stopped);
    EXPECT_TRUE(out.metrics.runs.empty());
}

TEST(Collect, SpreadsAreOfAllSeeds) {
    const Measured out = test::measured(test::small_experiment());
    EXPECT_EQ(out.metrics.runs.size(), 15u);  // 5 of each of 3 seeds
    EXPECT_EQ(out.films.size(), 5u);          // of the first
    ASSERT_FALSE(out.metrics.bands.empty());
    for (const SeedSpread& band : out.metrics.bands) EXPECT_EQ(band.band.seeds, 3) << band.metric;
    EXPECT_EQ(out.metrics.ladders.size(), 2u);  // of the arms with two sample counts
    EXPECT_EQ(out.metrics.geometry_pixels,
        out.metrics.shape_pixels.at("ball") + out.metrics.shape_pixels.at("block") +
            out.metrics.shape_pixels.at("ground"));
}

TEST(Collect, ProvenanceNamesTheSeedsOfThePart) {
    const Experiment e = test::small_experiment();
    const RunPlan part = plan(e, {2, 3});
    const Provenance p = provenance_of(part, *cpu_backend(""), "");
    EXPECT_EQ(p.seeds, part.seeds);
    EXPECT_THAT(p.places, ElementsAre(2, 3));
    EXPECT_THAT(p.missing(), ElementsAre(1));
    EXPECT_EQ(p.series, 3);
    EXPECT_EQ(p.version, version());
    EXPECT_EQ(p.experiment_hash, fmt::format("{:016x}", hash(e)));
    EXPECT_EQ(hash(parse(p.experiment_text, "again")), hash(e));
    EXPECT_EQ(p.command, "crescent run test.toml");
    EXPECT_EQ(provenance_of(part, *cpu_backend(""), "typed").command, "typed");
}

/// A sampler that names the device on which it is evaluated.
class OnADevice : public SamplerAdapter {
public:
    SamplerDeclaration declaration() const override {
        return {.name = "shader", .device = {.name = "a device", .driver = "a driver", .precision = "single"}};
    }
    void evaluate(const SamplerQuery&, const SamplerAnswers&) const override {}
};

TEST(Collect, ProvenanceNamesTheDevicesOfArms) {
    ProgressMonitor monitor;
    const RunPlan all = plan(test::small_experiment({"arms.mine.exec='./it'", "arms.mine.n=[4]", "arms.both.kind='mis'",
        "arms.both.of=['cosine', 'mine']", "arms.both.n=[4]", "seeds=1"}));
    const Engine engine{.samplers = {{"mine", std::make_shared<OnADevice>()}}};
    const Measured out = collect(all, prepare(all, engine, monitor), {}, engine, monitor, {.studies = false});
    EXPECT_THAT(out.provenance.backend_details,
        ElementsAre(Pair("device of both", "a device, a driver, single precision"),
            Pair("device of mine", "a device, a driver, single precision")));
}

TEST(Collect, TailsAreOfTheSamplesOfARegion) {
    ProgressMonitor monitor;
    const Experiment e = test::small_experiment();
    const Scene scene(e);
    const Job cosine{"cosine", "cosine", {4}, 24, 11, {}};
    const ShapeMap shapes = shape_map(scene);
    const AreaPixels pixels({{0, 0, 7, 5}}, shapes);
    const auto tail = region_tail(scene, cosine, pixels, "", monitor);
    ASSERT_TRUE(tail);
    const auto same = region_tail(scene, cosine, pixels, "", monitor);
    EXPECT_EQ(tail->k, same->k);
    EXPECT_GT(tail->exceedances, 0u);
}

}  // namespace collect_test
}  // namespace crescent
