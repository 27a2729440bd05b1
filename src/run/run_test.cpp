// The steps of a run: each alone, in any order of jobs, stopped by a flag, without changes to the process.
#include "run/run.h"

#include <OpenEXR/ImfThreading.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <clocale>
#include <csignal>
#include <filesystem>

#include "base/progress.h"
#include "experiment/identity.h"

namespace crescent {
namespace run_test {

namespace fs = std::filesystem;

Experiment tiny(std::vector<std::string> overrides = {}) {
    overrides.insert(
        overrides.end(), {"seeds=2", "image.width=48", "image.height=27", "regions.ball.box=[20,10,28,17]"});
    return load(std::string(CRESCENT_SOURCE_DIR) + "/tests/system/tiny.toml", overrides);
}

std::string metrics_of(Measured measured) { return metrics_json(report_inputs(measured)); }

TEST(RunSteps, AnyOrderOfJobsGivesTheSameNumbers) {
    ProgressMonitor monitor;
    const RunPlan plan = crescent::plan(tiny());
    Prepared prepared = prepare(plan, {.threads = 1}, monitor);
    std::vector<JobResult> results;
    for (std::size_t k = plan.jobs.size(); k-- > 0;)
        results.push_back(
            execute(plan, prepared, plan.jobs[k], {.threads = 2}, monitor, plan.jobs[k].seed == plan.seeds[0]));
    const Measured stepwise = collect(plan, std::move(prepared), std::move(results), {}, monitor);
    EXPECT_EQ(metrics_of(stepwise), metrics_of(measure_in_memory(tiny(), {}, monitor)));
    EXPECT_EQ(stepwise.metrics.runs.size(), 12u);
    EXPECT_NE(stepwise.film({"cosine", 16, 32, 7}), nullptr);
    EXPECT_NE(stepwise.reference(32), nullptr);
    EXPECT_EQ(stepwise.reference(8), nullptr);
    EXPECT_EQ(stepwise.metrics.references[0].max_relative_rmse_change, std::nullopt)
        << "the note's reference was not asked for";
    EXPECT_TRUE(stepwise.monte_carlo.empty());
}

/// Keeps every stage: what, units done, their total.
class Stages : public PolledMonitor {
public:
    std::vector<State> all;
    void begin(std::string_view what, double total) override {
        finish();
        PolledMonitor::begin(what, total);
    }
    void finish() {
        if (!state().what.empty()) all.push_back(state());
    }
};

TEST(RunSteps, EndTheirStagesAtTheirTotals) {
    Stages stages;
    const Measured measured = measure_in_memory(tiny(), {}, stages);
    stages.finish();
    ASSERT_EQ(stages.all.size(), 4u);
    EXPECT_EQ(stages.all[1].what, "seed 1 of 2");
    EXPECT_THAT(
        stages.all[3].what, ::testing::MatchesRegex("tails, furnaces, article checks: [0-9]+ % of all samples"));
    for (const PolledMonitor::State& stage : stages.all) EXPECT_DOUBLE_EQ(stage.progress, stage.total) << stage.what;
    ASSERT_EQ(measured.timing.stages.size(), 4u);
    EXPECT_EQ(measured.timing.stages[0].first, "references");
}

TEST(RunSteps, WithoutStudiesHaveTheSameOtherMetrics) {
    ProgressMonitor monitor;
    const Measured studied = measure_in_memory(tiny(), {}, monitor);
    const Measured unstudied = measure_in_memory(tiny(), {.studies = false}, monitor);
    EXPECT_TRUE(studied.metrics.has_studies);
    EXPECT_FALSE(unstudied.metrics.has_studies);
    Measured without_tails = studied;
    for (RunMetrics& run : without_tails.metrics.runs)
        for (RegionMetrics& region : run.regions) region.tail.reset();
    EXPECT_NE(metrics_csv(report_inputs(studied)), metrics_csv(report_inputs(unstudied)));
    EXPECT_EQ(metrics_csv(report_inputs(without_tails)), metrics_csv(report_inputs(unstudied)));
}

TEST(RunSteps, WithoutReferencesHaveTheFilmsOfTheFirstSeedAlone) {
    ProgressMonitor monitor;
    const Measured whole = measure_in_memory(tiny(), {}, monitor);
    const Measured films = measure_in_memory(tiny(), {.references = false}, monitor);
    ASSERT_EQ(films.films.size(), whole.films.size());
    for (const auto& [key, film] : films.films) EXPECT_EQ(hash(film), hash(*whole.film(key))) << to_string(key);
    EXPECT_TRUE(films.metrics.runs.empty());
    EXPECT_EQ(films.reference(32), nullptr);
    EXPECT_FALSE(films.metrics.assertions.empty());
    for (const AssertionResult& assertion : films.metrics.assertions)
        EXPECT_EQ(assertion.skipped, "no reference was computed");
}

TEST(RunSteps, ComputeTheArticleReferenceOnRequest) {
    ProgressMonitor monitor;
    const RunPlan plan = crescent::plan(tiny({"reference.monte_carlo=true", "seeds=1"}));
    const Prepared prepared = prepare(plan, {}, monitor);
    ASSERT_EQ(prepared.monte_carlo.size(), 1u);
    EXPECT_EQ(prepared.quadrature.size(), 1u);
}

TEST(RunSteps, AnswerAStopWithoutAnException) {
    PolledMonitor monitor;
    const RunPlan plan = crescent::plan(tiny());
    Prepared prepared = prepare(plan, {}, monitor);
    EXPECT_FALSE(prepared.stopped);
    EXPECT_EQ(monitor.state().what, "reference by quadrature");
    EXPECT_EQ(monitor.state().progress, monitor.state().total);
    JobResult first = execute(plan, prepared, plan.jobs[0], {}, monitor);
    EXPECT_FALSE(first.stopped);
    monitor.stop = true;
    EXPECT_TRUE(prepare(plan, {}, monitor).stopped);
    EXPECT_TRUE(execute(plan, prepared, plan.jobs[1], {}, monitor).stopped);
    Measured measured = collect(plan, std::move(prepared), {std::move(first)}, {}, monitor);
    EXPECT_TRUE(measured.stopped);
    const std::string out = fs::path(testing::TempDir()) / ("stopped-" + std::to_string(getpid()));
    EXPECT_FALSE(write(measured, out, monitor));
    EXPECT_FALSE(fs::exists(out + "/metrics.json"));
    fs::remove_all(out);
}

struct Process {
    std::vector<void (*)(int)> handlers;
    std::string locale;
    std::size_t tbb;
    int exr;

    Process()
        : locale(std::setlocale(LC_ALL, nullptr)),
          tbb(oneapi::tbb::global_control::active_value(oneapi::tbb::global_control::max_allowed_parallelism)),
          exr(Imf::globalThreadCount()) {
        for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGALRM, SIGCHLD, SIGXFSZ}) {
            struct sigaction now{};
            sigaction(signal, nullptr, &now);
            handlers.push_back(now.sa_handler);
        }
    }
    bool operator==(const Process&) const = default;
};

/// Checks the process whenever work is done, on the thread that does it.
struct Looker : ProgressMonitor {
    Process before;
    std::atomic<int> changed{0};
    void advance(double) override { changed += !(Process() == before); }
};

TEST(RunSteps, ChangeNothingThatBelongsToTheProcess) {
    Looker monitor;
    const std::string out = fs::path(testing::TempDir()) / ("steps-" + std::to_string(getpid()));
    RunOptions options;
    options.out = out;
    options.threads = 3;
    run(tiny({"seeds=1"}), options, monitor);
    EXPECT_TRUE(fs::exists(out + "/films/reference.exr"));
    EXPECT_EQ(monitor.changed, 0) << "while it ran";
    EXPECT_TRUE(Process() == monitor.before) << "afterwards";
    fs::remove_all(out);
}

TEST(RunPlans, TakeAPartOfTheSeriesOfSeeds) {
    const Experiment e = tiny({"seeds=9"});  // the last --set applies: tiny() sets 2
    EXPECT_EQ(plan(e).seeds.size(), 2u);
    Experiment five = e;
    five.seeds = 5;
    const std::vector<std::uint32_t> series = seeds_of(five);
    const RunPlan part = plan(five, {2, 3});
    EXPECT_EQ(part.seeds, (std::vector<std::uint32_t>{series[1], series[2]}));
    EXPECT_EQ(part.hash, hash(five)) << "the experiment is the same";
    EXPECT_EQ(part.jobs.size(), 6u);
    for (const SeedRange wrong : {SeedRange{0, 1}, SeedRange{3, 2}, SeedRange{1, 6}, SeedRange{6, 0}})
        EXPECT_THROW(plan(five, wrong), InputError) << wrong.first << ":" << wrong.last;
}

TEST(OutputParts, AreNamedWithTheNearestWord) {
    EXPECT_TRUE(output_parts("report,metrics").metrics);
    EXPECT_FALSE(output_parts("report,metrics").films);
    for (const char* wrong : {"", "metrix", "films,", "films, report"}) EXPECT_THROW(output_parts(wrong), InputError);
    try {
        output_parts("plate");
        FAIL();
    } catch (const InputError& e) { EXPECT_THAT(e.what(), testing::HasSubstr("did you mean 'plates'?")); }
}

}  // namespace run_test
}  // namespace crescent
