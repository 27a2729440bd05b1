// What can fail early comes first: the font, the view, the samplers, the folder, the outputs' names. Then references,
// jobs, collect, write, commit; the checkpoint is removed last, and there is none if an arm is a program, or without
// references. Films alone need only the first seed.
#include "run/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/errors.h"
#include "base/files.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "run/checkpoint.h"
#include "run/execute.h"
#include "run/external_samplers.h"
#include "run/plan.h"

namespace crescent {

namespace {

/// Films alone need neither other seeds nor the additional measurements.
bool films_alone(const RunOptions& options) {
    const OutputParts& parts = options.parts;
    return !options.references || (parts.films && !parts.metrics && !parts.draws());
}

RunPlan plan_of(const Experiment& experiment, const RunOptions& options) {
    RunPlan out = plan(experiment, options.seeds);
    if (films_alone(options)) out = plan(experiment, {out.range.first, out.range.first});
    out.references = options.references;
    return out;
}

void check_options(const RunOptions& options) {
    if (!options.references && options.parts.draws())
        throw InputError({"--no-references", 0, 0},
            "expected together with --only metrics, films or both: plates and the report need a reference");
}

double samples_of(const RunPlan& plan, std::uint32_t seed, std::uint64_t pixels) {
    double samples = 0;
    for (const Job& job : plan.jobs)
        if (job.seed == seed) samples += static_cast<double>(job.n.back()) * static_cast<double>(pixels);
    return samples;
}

std::vector<JobResult> execute_all(const RunPlan& plan, const Prepared& prepared, const Engine& engine,
    ProgressMonitor& monitor, Checkpoint* checkpoint) {
    std::vector<JobResult> results;
    for (std::size_t k = 0; k < plan.jobs.size(); ++k) {
        const Job& job = plan.jobs[k];
        begin_seed(plan, k, prepared.geometry_pixels, monitor);
        results.push_back(execute(plan, prepared, job, engine, monitor, job.seed == plan.seeds.front(), checkpoint));
        monitor.check();
    }
    return results;
}

/// Does all steps except the last; throws Interrupted.
Measured measured(const RunPlan& plan, Prepared prepared, const Engine& engine, const RunOptions& options,
    ProgressMonitor& monitor, Checkpoint* checkpoint) {
    const Stopwatch start;
    add_references(plan, prepared, engine, monitor);
    monitor.check();
    const double references = start.seconds();
    std::vector<JobResult> results = execute_all(plan, prepared, engine, monitor, checkpoint);
    const double estimating = start.seconds();
    Measured out = collect(plan, std::move(prepared), std::move(results), engine, monitor,
        {options.command, options.studies && !films_alone(options)});
    monitor.check();
    out.timing.estimating_s = estimating;
    out.timing.stages.insert(
        out.timing.stages.begin(), {{"references", references}, {"films", estimating - references}});
    return out;
}

/// A checkpoint belongs to one back end, one experiment and one part of its seeds.
std::string checkpoint_key(const RunPlan& plan, const Engine& engine) {
    return fmt::format("{} {:016x} {}:{}", engine.backend->name(), plan.hash, plan.range.first, plan.range.last);
}

Engine engine_of(const RunOptions& options) {
    return settled({options.threads, options.isa, options.backend, options.timeout_s});
}

}  // namespace

void begin_seed(const RunPlan& plan, std::size_t job, std::uint64_t pixels, ProgressMonitor& monitor) {
    const std::uint32_t seed = plan.jobs[job].seed;
    if (job > 0 && seed == plan.jobs[job - 1].seed) return;
    const auto place = std::ranges::find(plan.seeds, seed) - plan.seeds.begin();
    monitor.begin(
        fmt::format("seed {} of {}", plan.range.first + place, plan.whole.seeds), samples_of(plan, seed, pixels));
}

RunResult run(const Experiment& experiment, const RunOptions& options, ProgressMonitor& monitor) {
    check_options(options);
    const Stopwatch start;
    const std::string out = std::filesystem::absolute(options.out).string();  // a sampler may change the current folder
    const Engine engine = engine_of(options);
    const RunPlan plan = plan_of(experiment, options);
    if (options.parts.draws()) check_font(plan.experiment);
    Prepared prepared = look(plan, engine);
    log_warnings(plan, prepared, monitor);
    Staging staging(out);
    staging.expect(outputs_of(plan, options.parts));
    std::optional<Checkpoint> checkpoint;  // a program may draw differently in the next run
    if (plan.references && !may_change(plan.experiment))
        checkpoint.emplace(plan.experiment, checkpoint_key(plan, engine), out, options.keep_after_s, monitor);
    Measured results =
        measured(plan, std::move(prepared), engine, options, monitor, checkpoint ? &*checkpoint : nullptr);
    results.timing.total_s = start.seconds();
    on_threads(threads_to_be_had(engine.threads), [&] { write(results, staging, monitor, options.parts); });
    staging.commit(monitor);
    if (checkpoint) checkpoint->discard();
    std::string summary =
        terminal_summary(report_inputs(results), results.timing, options.out, options.parts, false, options.columns);
    return {std::move(results.metrics), std::move(results.timing), std::move(results.provenance), std::move(summary)};
}

Measured measure_in_memory(const Experiment& experiment, const RunOptions& options, ProgressMonitor& monitor) {
    const Engine engine = engine_of(options);
    const RunPlan plan = plan_of(experiment, options);
    Prepared prepared = look(plan, engine);
    log_warnings(plan, prepared, monitor);
    return measured(plan, std::move(prepared), engine, options, monitor, nullptr);
}

}  // namespace crescent
