// Results are sorted into the plan's order; tails are computed in parallel with article checks and furnaces; then
// hashes, bands, ladders and the comparison of references are made of the films and metrics, and the assertions that
// need no plate are checked.
#include "run/collect.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "base/parallel.h"
#include "base/progress.h"
#include "experiment/identity.h"
#include "experiment/published.h"
#include "metrics/article_checks.h"
#include "metrics/assertions.h"
#include "metrics/furnace.h"
#include "metrics/metrics.h"
#include "render/estimator.h"
#include "run/plan.h"
#include "run/version.h"

namespace crescent {

namespace {

const Published* figures_of(const Experiment& experiment) {
    return experiment.figures ? &*experiment.figures : nullptr;
}

/// Sorts results into the plan's order.
void sort_results(const RunPlan& plan, std::vector<JobResult>& results) {
    const auto place = [&](const JobResult& r) {
        return std::ranges::find_if(plan.jobs, [&](const Job& job) {
            return job.arm == r.job.arm && job.n == r.job.n && job.s == r.job.s && job.seed == r.job.seed;
        });
    };
    std::ranges::sort(results, {}, place);
}

void take_results(std::vector<JobResult>&& results, Measured& out) {
    for (JobResult& result : results) {
        out.stopped = out.stopped || result.stopped;
        if (result.stopped) continue;
        const Job& job = result.job;
        out.timing.arms.push_back(
            {job.arm, job.n.back(), job.s, static_cast<std::uint64_t>(result.samples), result.seconds});
        for (Film& film : result.films) {
            const RunKey key{job.arm, film.n, job.s, job.seed};
            out.films.emplace_back(key, std::move(film));
        }
        auto& runs = out.metrics.runs;
        runs.insert(runs.end(), result.metrics.begin(), result.metrics.end());
    }
}

/// The tail index of each region's samples, from the stream of the experiment's own seed for every part of its series.
/// It depends on arm and exponent, not on N, and is stored with every N of the first seed.
void add_tails(
    const RunPlan& plan, const Prepared& prepared, const std::string& isa, ProgressMonitor& monitor, Metrics& metrics) {
    const std::vector<Job> jobs = jobs_of(plan.whole, plan.whole.seed);
    const std::vector<Region>& regions = plan.experiment.regions;
    std::vector<std::optional<Tail>> tails(jobs.size() * regions.size());
    parallel_for(std::size_t{0}, tails.size(), [&](std::size_t k) {
        const Job job = with_sampler(jobs[k / regions.size()], prepared);
        tails[k] = region_tail(prepared.scene.with_s(job.s), job,
            AreaPixels(regions[k % regions.size()].area(), prepared.shapes), isa, monitor);
        monitor.advance(1);
    });
    for (std::size_t k = 0; k < tails.size(); ++k) {
        const Job& job = jobs[k / regions.size()];
        for (RunMetrics& run : metrics.runs)
            if (run.key.seed == plan.seeds.front() && run.key.arm == job.arm && run.key.s == job.s)
                run.regions[k % regions.size()].tail = tails[k];
    }
}

/// Begins the stage of the tails, furnaces and article checks, with its share of the samples of the run: those that
/// films have at geometry pixels, and those of tails and furnaces, at most.
void begin_studies(const RunPlan& plan, const Prepared& prepared, ProgressMonitor& monitor) {
    double films = 0, studies = 0;
    for (const Job& job : plan.jobs)
        films += static_cast<double>(job.n.back()) * static_cast<double>(prepared.geometry_pixels);
    const std::size_t jobs = jobs_of(plan.whole, plan.whole.seed).size();
    for (const Region& region : plan.experiment.regions) {
        const std::uint64_t pixels = AreaPixels(region.area(), prepared.shapes).count();
        studies += static_cast<double>(jobs) * static_cast<double>(tail_plan(pixels).n * pixels);
    }
    for (const FurnacePlan& furnace : plan.whole.furnaces) studies += static_cast<double>(furnace.n);
    const double share = films + studies > 0 ? studies / (films + studies) : 0;
    const std::size_t units = jobs * plan.experiment.regions.size() + plan.whole.furnaces.size() + 1;
    monitor.begin(fmt::format("tails, furnaces, article checks: {:.0f} % of all samples", 100 * share),
        static_cast<double>(units));
}

void add_hashes(Measured& out) {
    std::vector<std::pair<std::string, std::function<std::string()>>> films;
    for (const auto& [key, film] : out.films) films.emplace_back(to_string(key), [&] { return hash(film); });
    for (const ReferenceFilm& film : out.quadrature)
        films.emplace_back(fmt::format("quadrature s={}", film.s), [&] { return hash(film); });
    for (const ReferenceFilm& film : out.monte_carlo)
        films.emplace_back(fmt::format("note reference s={}", film.s), [&] { return hash(film); });
    for (const ReferenceFilm& film : out.paired)
        films.emplace_back(fmt::format("paired s={}", film.s), [&] { return hash(film); });
    std::vector<std::string> hashes(films.size());
    parallel_for(std::size_t{0}, films.size(), [&](std::size_t k) { hashes[k] = films[k].second(); });
    for (std::size_t k = 0; k < films.size(); ++k) out.metrics.film_hashes[films[k].first] = hashes[k];
}

void add_references_compared(Measured& out) {
    const Experiment& experiment = out.experiment;
    Metrics& metrics = out.metrics;
    std::ranges::move(
        paired_quality(out.paired, experiment, metrics.runs, out.shapes), std::back_inserter(metrics.references));
    for (std::size_t e = 0; e < out.quadrature.size(); ++e)
        for (const Region& region : experiment.regions)
            metrics.references.push_back(
                compare(out.quadrature[e], out.monte_carlo.empty() ? nullptr : &out.monte_carlo[e], region, out.films,
                    experiment.reference.kind, out.shapes));
}

void add_view(Prepared& prepared, Measured& out) {
    for (std::size_t k = 0; k < prepared.shape_pixels.size(); ++k)
        out.metrics.shape_pixels[out.experiment.surface_name(k)] = prepared.shape_pixels[k];
    out.metrics.geometry_pixels = prepared.geometry_pixels;
    out.shapes = std::move(prepared.shapes);
    for (Region& region : out.experiment.regions) region.box = AreaPixels(region.area(), out.shapes).bounds();
    out.outside = std::move(prepared.outside);
    out.quadrature = std::move(prepared.quadrature);
    out.monte_carlo = std::move(prepared.monte_carlo);
    out.paired = std::move(prepared.paired);
}

/// Adds the device of each arm that names one.
void add_devices(const ExternalSamplers& external_samplers, Provenance& to) {
    for (const auto& [arm, sampler] : external_samplers)
        if (const EvaluationDevice device = sampler->declaration().device; device.declared())
            to.backend_details.emplace_back("device of " + arm, device.text());
}

}  // namespace

const Film* Measured::film(const RunKey& key) const {
    const auto match = std::ranges::find(films, key, &std::pair<RunKey, Film>::first);
    return match == films.end() ? nullptr : &match->second;
}

const ReferenceFilm* Measured::reference(double s) const { return reference_of(experiment, *this, s); }

std::optional<Tail> region_tail(
    const Scene& scene, const Job& job, const AreaPixels& pixels, const std::string& isa, ProgressMonitor& monitor) {
    return region_tail(scene, SamplerRef{job.sampler, job.outside.get()}, job.seed, pixels, isa, monitor);
}

void add_spreads(Measured& out) {
    const Experiment& experiment = out.experiment;
    Metrics& metrics = out.metrics;
    const Published* published = figures_of(experiment);
    metrics.bands = bands(experiment, metrics.runs, published);
    metrics.published_seed = published ? published->seed : std::nullopt;
    metrics.ladders = ladders(experiment, metrics.runs);
    metrics.assertions = evaluate_assertions(experiment, metrics, {}, false);
}

Provenance provenance_of(const RunPlan& plan, const Backend& backend, const std::string& command) {
    Provenance p;
    p.version = version();
    p.commit = commit();
    p.compiler = compiler();
    p.experiment_file = plan.experiment.file;
    p.experiment_hash = fmt::format("{:016x}", plan.hash);
    p.backend = backend.name();
    p.backend_details = backend.details();
    p.command = command.empty() ? "crescent run " + plan.experiment.file : command;
    p.seeds = plan.seeds;
    for (int place = plan.range.first; place <= plan.range.last; ++place) p.places.push_back(place);
    p.series = plan.whole.seeds;
    p.experiment_text = canonical_text(plan.whole);
    return p;
}

Measured collect(const RunPlan& plan, Prepared prepared, std::vector<JobResult> results, const Engine& engine,
    ProgressMonitor& monitor, const CollectOptions& options) {
    const Engine settled_engine = settled(engine);
    Measured out;
    out.experiment = plan.experiment;
    out.timing.threads = settled_engine.threads;
    out.timing.isa = settled_engine.isa;
    out.stopped = prepared.stopped;
    sort_results(plan, results);
    take_results(std::move(results), out);
    prepared.views.clear();  // no more films: their points are given up
    const auto stage = [&](const char* name, const auto& work) {
        const Stopwatch start;
        out.stopped = out.stopped || !unless_stopped(settled_engine.threads, monitor, work);
        out.timing.stages.emplace_back(name, start.seconds());
    };
    if (options.studies) {
        begin_studies(plan, prepared, monitor);
        stage("tails, furnaces and article checks", [&] {  // these do not depend on each other
            side_by_side([&] { add_tails(plan, prepared, settled_engine.isa, monitor, out.metrics); },
                [&] {
                    out.evidence = measure_evidence(plan.whole, settled_engine.isa, monitor);
                    monitor.advance(1);
                    out.metrics.furnaces =
                        furnaces(plan.whole, figures_of(out.experiment), settled_engine.isa, monitor, prepared.outside);
                    monitor.advance(static_cast<double>(plan.whole.furnaces.size()));
                });
        });
    }
    add_view(prepared, out);
    out.metrics.series = seeds_of(plan.whole);
    out.metrics.has_studies = options.studies;
    stage("metrics", [&] {
        add_hashes(out);
        add_references_compared(out);
        add_spreads(out);
    });
    if (!plan.references)
        for (AssertionResult& assertion : out.metrics.assertions) assertion.skipped = "no reference was computed";
    out.provenance = provenance_of(plan, *settled_engine.backend, options.command);
    add_devices(out.outside, out.provenance);
    for (AssertionResult& a : settled_engine.backend->assertions()) out.metrics.assertions.push_back(std::move(a));
    return out;
}

}  // namespace crescent
