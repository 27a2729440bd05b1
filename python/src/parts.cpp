// Parts of runs, for crescent/sweep: references that several runs share, runs of some arms and seeds, what does not
// depend on the seed, and the run that all of these add up to.
#include <algorithm>
#include <map>
#include <set>

#include "module.h"
#include "run_result.h"
#include "watched.h"

namespace crescent::python {

namespace {

using Names = std::vector<std::string>;

/// The references of an experiment, one for each exponent.
struct References {
    std::vector<ReferenceFilm> quadrature, monte_carlo, paired;
};

References references(const Experiment& experiment, int threads, const std::string& isa, const nb::object& progress) {
    PolledMonitor monitor;
    Raised raised(monitor);
    References out;
    watched(monitor, raised, progress, false, [&] {
        RunPlan what = plan(experiment, {1, 1});
        what.experiment.arms.clear();
        what.experiment.exponent.reset();  // opens no sampler
        Prepared prepared = prepare(what, settled({.threads = threads, .isa = isa}), monitor);
        monitor.check();
        out = {std::move(prepared.quadrature), std::move(prepared.monte_carlo), std::move(prepared.paired)};
    });
    return out;
}

/// Sets the tail indices of the rows of the first seed, as collect() does with studies.
void add_tails(const RunPlan& what, const Scene& scene, const std::string& isa, ProgressMonitor& monitor,
    const std::vector<Job>& jobs, const ShapeMap& shapes, Metrics& metrics) {
    for (const Job& job : jobs) {
        if (job.seed != what.whole.seed) continue;
        for (const Region& region : what.experiment.regions) {
            const std::optional<Tail> tail =
                region_tail(scene.with_s(job.s), job, AreaPixels(region.area(), shapes), isa, monitor);
            monitor.check();
            for (RunMetrics& run : metrics.runs)
                if (run.key.seed == job.seed && run.key.arm == job.arm && run.key.s == job.s)
                    for (RegionMetrics& row : run.regions)
                        if (row.region == region.name) row.tail = tail;
        }
    }
}

/// States an experiment without the files of its samplers, which may change or be on another machine when the text is
/// read: read_metrics() checks the hash, and the sweep has an identity of its own for each sampler.
void leave_out_files(const RunPlan& what, Provenance& provenance) {
    Experiment portable_experiment = what.whole;
    for (ArmPlan& arm : portable_experiment.arms)
        if (arm.is_external()) {
            arm.sampler = "uniform";
            arm.exec.reset();
            arm.plugin.reset();
            arm.python.reset();
        }
    provenance.experiment_text = canonical_text(portable_experiment);
    provenance.experiment_hash = fmt::format("{:016x}", hash(portable_experiment));
}

/// Runs these arms with seeds first to last against given references. The part with the experiment's own seed has the
/// tail indices of its arms.
RunResult run_part(const Experiment& experiment, int first, int last, const Names& arms, const References& references,
    int threads, const std::string& isa, const nb::object& progress, const CallableArms& callables) {
    PolledMonitor monitor;
    Raised raised(monitor);
    RunResult out;
    const auto [samplers, serial] = samplers_of(callables, raised);
    watched(monitor, raised, progress, serial, [&] {
        RunPlan what = plan(experiment, {first, last});
        const auto is_other = [&](const std::string& name) { return std::ranges::find(arms, name) == arms.end(); };
        std::erase_if(what.jobs, [&](const Job& job) { return is_other(job.arm); });
        Experiment& part_experiment = what.experiment;  // no other sampler is opened
        part_experiment = with_arms_of(std::move(part_experiment), arms);
        part_experiment.assertions.clear();
        if (part_experiment.exponent && is_other(part_experiment.exponent->arm)) part_experiment.exponent.reset();
        const Engine engine = settled({.threads = serial ? 1 : threads, .isa = isa, .samplers = samplers});
        Prepared prepared = look(what, engine);
        prepared.quadrature = references.quadrature;
        prepared.monte_carlo = references.monte_carlo;
        prepared.paired = references.paired;
        const Scene scene = prepared.scene;
        std::vector<Job> jobs;
        std::vector<JobResult> results;
        for (const Job& job : what.jobs) {
            monitor.check();
            jobs.push_back(with_sampler(job, prepared));
            results.push_back(execute(what, prepared, job, engine, monitor, job.seed == what.seeds.front()));
        }
        monitor.check();
        Measured result =
            collect(what, std::move(prepared), std::move(results), engine, monitor, {"crescent sweep", false});
        monitor.check();
        on_threads(
            engine.threads, [&] { add_tails(what, scene, engine.isa, monitor, jobs, result.shapes, result.metrics); });
        result.metrics.has_studies = true;  // furnaces and article checks are a result of their own: studies()
        leave_out_files(what, result.provenance);
        out = result_of(std::move(result));
    });
    return out;
}

/// Measures what a run adds to the films of its arms and does not depend on the seeds: furnaces, and the checks of the
/// article's claims.
RunResult studies(const Experiment& experiment, int threads, const std::string& isa, const nb::object& progress,
    const CallableArms& callables) {
    PolledMonitor monitor;
    Raised raised(monitor);
    RunResult out;
    const auto [samplers, serial] = samplers_of(callables, raised);
    watched(monitor, raised, progress, serial, [&] {
        RunPlan what = plan(experiment, {1, 1});
        what.jobs.clear();  // no rows, so no tails of regions and no assertions
        what.experiment.regions.clear();
        what.experiment.assertions.clear();
        const Engine engine = settled({.threads = serial ? 1 : threads, .isa = isa, .samplers = samplers});
        Measured result = collect(what, look(what, engine), {}, engine, monitor, {"crescent sweep", true});
        monitor.check();
        leave_out_files(what, result.provenance);
        out = result_of(std::move(result));
    });
    return out;
}

/// The largest of what the parts with the first seed state of each reference: parts differ in the films that they
/// compare the references by.
void merge_references(const std::vector<ReferenceQuality>& part, std::vector<ReferenceQuality>& references) {
    if (references.empty()) references = part;
    for (std::size_t k = 0; k < std::min(references.size(), part.size()); ++k) {
        references[k].error_share = std::max(references[k].error_share, part[k].error_share);
        references[k].max_relative_rmse_change =
            std::max(references[k].max_relative_rmse_change, part[k].max_relative_rmse_change);
    }
}

/// Returns the run of seeds first to last from parts that have all of its arms and seeds, and the studies: the texts of
/// their metrics.json. Its bytes are those of one run of all. Throws InputError if a row is missing.
RunResult assemble(
    const Experiment& experiment, int first, int last, const Names& parts, const std::string& measured_once) {
    const Work work_scope;
    const RunPlan what = plan(experiment, {first, last});
    Measured out;
    out.experiment = what.experiment;
    Metrics& metrics = out.metrics;
    MetricsFile studies = read_metrics(measured_once, "the studies of the sweep");
    out.evidence = std::move(studies.evidence);
    metrics.furnaces = std::move(studies.metrics.furnaces);
    metrics.geometry_pixels = studies.metrics.geometry_pixels;
    metrics.shape_pixels = studies.metrics.shape_pixels;
    std::map<std::tuple<std::string, std::uint64_t, double, std::uint32_t>, RunMetrics> rows;
    const auto key_of = [](const RunKey& key) { return std::tuple(key.arm, key.n, key.s, key.seed); };
    for (const std::string& text : parts) {
        MetricsFile part = read_metrics(text, "a part of the sweep");
        const bool is_first = part.provenance.seeds.front() == what.seeds.front();
        std::set<std::string> films;
        for (RunMetrics& run : part.metrics.runs) {
            films.insert(to_string(run.key));
            rows[key_of(run.key)] = std::move(run);
        }
        for (auto& [name, hash] : part.metrics.film_hashes)
            if (is_first || !films.contains(name)) metrics.film_hashes[name] = hash;
        if (is_first) merge_references(part.metrics.references, metrics.references);
    }
    for (const Job& job : what.jobs)
        for (const std::uint64_t n : job.n) {
            const auto row = rows.find(key_of({job.arm, n, job.s, job.seed}));
            if (row == rows.end())
                throw InputError({"the parts of the sweep", 0, 0},
                    fmt::format("no row of {} at seed {}", to_string(RunKey{job.arm, n, job.s, job.seed}), job.seed));
            metrics.runs.push_back(row->second);
        }
    metrics.series = seeds_of(what.whole);
    add_spreads(out);
    out.provenance = provenance_of(what, *settled({}).backend, "crescent sweep");
    return result_of(std::move(out));
}

using ReferencesState = std::tuple<nb::object, nb::object, nb::object>;

ReferencesState state_of(nb::handle self) {
    const References& r = nb::cast<const References&>(self);
    return {reference_list(r.quadrature, self), reference_list(r.monte_carlo, self), reference_list(r.paired, self)};
}

void restore(References& into, const ReferencesState& state) {
    References* const r = new (&into) References;
    restore_references(nb::cast<nb::list>(std::get<0>(state)), r->quadrature);
    restore_references(nb::cast<nb::list>(std::get<1>(state)), r->monte_carlo);
    restore_references(nb::cast<nb::list>(std::get<2>(state)), r->paired);
}

}  // namespace

void add_parts(nb::module_& m) {
    using namespace nb::literals;
    nb::class_<References>(m, "References", "The references of an experiment.")
        .def("__getstate__", [](nb::handle self) { return state_of(self); })
        .def("__setstate__", &restore);
    m.def("references", &references, "experiment"_a, "threads"_a, "isa"_a, "progress"_a.none());
    m.def("run_part", &run_part, "experiment"_a, "first"_a, "last"_a, "arms"_a, "references"_a, "threads"_a, "isa"_a,
        "progress"_a.none(), "callables"_a = CallableArms{});
    m.def(
        "studies", &studies, "experiment"_a, "threads"_a, "isa"_a, "progress"_a.none(), "callables"_a = CallableArms{});
    m.def("assemble", &assemble, "experiment"_a, "first"_a, "last"_a, "parts"_a, "studies"_a);
    m.def("instruction_sets", &isas, "The instruction sets that this machine can run, the best last.");
}

}  // namespace crescent::python
