// Jobs with a back end of constant films, whose metrics are known; what the camera sees; the CPU's films.
#include "run/execute.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "base/errors.h"
#include "render/estimator.h"
#include "run/checkpoint.h"
#include "tests/support/small_run.h"

namespace crescent {
namespace execute_test {

using ::testing::Contains;
using ::testing::ElementsAre;

/// Films of one grey.
class Grey : public Backend {
public:
    explicit Grey(float y) : y_(y) {}
    std::string name() const override { return "grey"; }
    void check(const Experiment& e) const override {
        if (e.find_arm("phong") == nullptr) throw InputError({}, "no phong");
    }
    std::vector<Film> films(const TiledScene& view, const Job& job, ProgressMonitor&) override {
        ++calls;
        std::vector<Film> out;
        for (const std::uint64_t n : job.n) {
            Film& film = out.emplace_back(view.scene().image().width, view.scene().image().height, n);
            for (auto* plane : {&film.r, &film.g, &film.b, &film.y}) std::ranges::fill(*plane, y_);
        }
        return out;
    }
    int calls = 0;

private:
    float y_;
};

TEST(Execute, MeasuresTheFilmsOfItsBackEnd) {
    ProgressMonitor monitor;
    const RunPlan all = plan(test::small_experiment());
    const auto backend = std::make_shared<Grey>(2.0f);
    const Prepared prepared = prepare(all, {.backend = backend}, monitor);
    const JobResult kept = execute(all, prepared, all.jobs[1], {.backend = backend}, monitor),
                    measured = execute(all, prepared, all.jobs[1], {.backend = backend}, monitor, false);
    EXPECT_EQ(backend->calls, 2);
    ASSERT_EQ(kept.metrics.size(), 2u);  // cosine at 4 and 16
    EXPECT_EQ(kept.films.size(), 2u);
    EXPECT_TRUE(measured.films.empty());
    EXPECT_EQ(kept.metrics[1].key, (RunKey{"cosine", 16, 24, 11}));
    EXPECT_DOUBLE_EQ(kept.metrics[1].y_mean, 2);
    EXPECT_EQ(kept.metrics[1].regions[0].rmse, measured.metrics[1].regions[0].rmse);
    const ReferenceFilm& reference = *reference_of(all.experiment, prepared, 24);
    EXPECT_DOUBLE_EQ(kept.metrics[0].regions[0].rmse,
        rms_difference(std::vector<float>(8 * 6, 2.0f), reference.y, AreaPixels({{0, 0, 7, 5}}, ShapeMap{8, 6, {}})));
    EXPECT_EQ(kept.samples, static_cast<double>(prepared.geometry_pixels * 16));
}

TEST(Execute, FlipIsMeasuredAtOneSampleCountOfTheFirstSeeds) {
    ProgressMonitor monitor;
    const RunPlan all = plan(test::small_experiment());
    const auto backend = std::make_shared<Grey>(2.0f);
    const Prepared prepared = prepare(all, {}, monitor);
    const auto has_flip = [&](std::size_t job) {
        std::vector<bool> out;
        for (const RunMetrics& m : execute(all, prepared, all.jobs[job], {.backend = backend}, monitor, false).metrics)
            out.push_back(m.regions[0].has_flip());
        return out;
    };
    EXPECT_THAT(has_flip(1), ElementsAre(false, true));
    EXPECT_THAT(has_flip(all.jobs.size() - 2), ElementsAre(false, false));  // the last seed
}

TEST(Execute, AFinishedPassIsTakenFromTheCheckpoint) {
    ProgressMonitor monitor;
    const RunPlan all = plan(test::small_experiment());
    const auto backend = std::make_shared<Grey>(2.0f);
    const Prepared prepared = prepare(all, {}, monitor);
    const std::string out = std::filesystem::path(testing::TempDir()) / ("execute-" + std::to_string(::getpid()));
    {
        Checkpoint checkpoint(all.experiment, "grey", out, 0, monitor);
        const auto y_mean = [&](std::size_t job, bool films) {
            return execute(all, prepared, all.jobs[job], {.backend = backend}, monitor, films, &checkpoint)
                .metrics[0]
                .y_mean;
        };
        EXPECT_EQ(y_mean(1, false), 2);
        EXPECT_EQ(y_mean(1, false), 2);
        EXPECT_EQ(backend->calls, 1);
        y_mean(1, true);  // films are not kept
        EXPECT_EQ(backend->calls, 2);
        checkpoint.discard();
    }
    std::filesystem::remove_all(out);
}

TEST(Execute, ShapesInViewAreCounted) {
    const Experiment e = test::small_experiment();
    ShapeMap shapes{4, 2, {0, 0, -1, 2, 2, 2, -1, -1}};
    EXPECT_THAT(count_in_view(e, shapes), ElementsAre(2, 0, 3));
    shapes.shape.assign(8, -1);
    EXPECT_THROW((void)count_in_view(e, shapes), InputError);
    const Prepared seen = look(plan(e));
    EXPECT_EQ(seen.geometry_pixels, seen.shape_pixels[0] + seen.shape_pixels[1] + seen.shape_pixels[2]);
    EXPECT_EQ(view_at(seen, 24).scene().s(), 24);
    EXPECT_THROW((void)view_at(seen, 25), Bug);
}

TEST(Execute, ABackEndMayRefuseAnExperiment) {
    Experiment e = test::small_experiment();
    const auto backend = std::make_shared<Grey>(1.0f);
    EXPECT_NO_THROW((void)look(plan(e), {.backend = backend}));
    std::erase_if(e.arms, [](const ArmPlan& arm) { return arm.name == "phong"; });
    EXPECT_THROW((void)look(plan(e), {.backend = backend}), InputError);
    EXPECT_EQ(find_backend("no such"), nullptr);
}

TEST(Execute, DefaultsAreTheCpuAndItsBestInstructions) {
    const Engine with = settled({});
    EXPECT_GE(with.threads, 1);
    EXPECT_THAT(isas(), Contains(with.isa));
    EXPECT_EQ(with.backend->name(), "CPU");
    EXPECT_THROW((void)settled({.isa = "sse99"}), InputError);
    ProgressMonitor monitor;
    const RunPlan all = plan(test::small_experiment());
    const Prepared seen = look(all);
    const Job& job = all.jobs[0];
    const auto films = with.backend->films(view_at(seen, job.s), job, monitor);
    EXPECT_EQ(films.at(0).y,
        estimate_films(view_at(seen, job.s), job.sampler, job.n, job.seed, isas().front(), monitor).at(0).y);
}

}  // namespace execute_test
}  // namespace crescent
