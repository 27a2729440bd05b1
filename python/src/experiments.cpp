// Experiments and runs, for crescent/experiments.py: an experiment file or text as input, films and numbers as output,
// all in memory.
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <iterator>
#include <optional>

#include "module.h"
#include "run_result.h"
#include "watched.h"

namespace crescent::python {

RunResult result_of(Measured&& m) {
    const ReportInputs in{m.experiment, m.metrics, m.evidence, m.provenance, m.plates};
    const Provenance& p = m.provenance;
    RunResult out{m.experiment.s(), m.metrics.all_hold(), metrics_json(in), metrics_csv(in), junit_xml(in),
        {{"crescent", p.version + " " + p.commit}, {"compiler", p.compiler},
            {"experiment", p.experiment_file + " " + p.experiment_hash}, {"instrument", p.backend}},
        {}, {}, {}, m.timing.threads, {}, m.timing.stages};
    for (const Region& r : m.experiment.regions) out.boxes.emplace_back(r.name, r.box.x0, r.box.y0, r.box.x1, r.box.y1);
    for (const ArmTiming& t : m.timing.arms) out.times.emplace_back(t.arm, t.n, t.s, t.samples, t.seconds);
    for (auto& [key, film] : m.films) out.films.emplace_back(key, std::move(film));
    for (auto* films : {&m.quadrature, &m.paired})
        for (ReferenceFilm& film : *films) out.references.push_back(std::move(film));
    return out;
}

SamplersOfCallables samplers_of(const CallableArms& callables, Raised& raised) {
    SamplersOfCallables out;
    for (const auto& [name, arm] : samplers_of(callables)) {
        arm->set_raised(&raised);
        out.serial = out.serial || arm->serial();
        out.samplers[name] = arm;
    }
    return out;
}

namespace {

constexpr std::pair<const char*, std::vector<float> Film::*> film_planes[] = {{"r", &Film::r}, {"g", &Film::g},
    {"b", &Film::b}, {"y", &Film::y}, {"y2", &Film::second_moment}, {"var", &Film::var}, {"largest", &Film::largest}};
constexpr std::pair<const char*, std::vector<std::uint32_t> Film::*> film_counts[] = {
    {"horizon", &Film::horizon}, {"hits", &Film::light_hits}};
nb::dict planes_of(const Film& f, nb::handle owner) {
    nb::dict out;
    for (const auto& [name, values] : film_planes) out[name] = plane(f.*values, f.width, f.height, owner);
    for (const auto& [name, values] : film_counts) out[name] = plane(f.*values, f.width, f.height, owner);
    return out;
}

using FilmList = nb::typed<nb::list, nb::typed<nb::tuple, std::string, int, double, int, Planes>>;

/// Returns every film of the run with its key, (arm, n, s, seed, planes).
FilmList films_of(nb::handle self) {
    nb::list out;
    for (const auto& [key, film] : nb::cast<const RunResult&>(self).films)
        out.append(nb::make_tuple(key.arm, key.n, key.s, key.seed, planes_of(film, self)));
    return out;
}

/// Returns the references that the metrics use, (s, planes).
ReferenceList references_of(nb::handle self) {
    return reference_list(nb::cast<const RunResult&>(self).references, self);
}

using State = std::tuple<double, bool, std::string, std::string, std::string, Attributes, Boxes, nb::object, nb::object,
    Times, int, Stages>;

State state_of(nb::handle self) {
    const RunResult& r = nb::cast<const RunResult&>(self);
    return {r.s, r.holds, r.json, r.csv, r.junit, r.attributes, r.boxes, films_of(self), references_of(self), r.times,
        r.threads, r.stages};
}

void restore(RunResult& into, const State& state) {
    RunResult* const r = new (&into) RunResult;
    nb::object films, references;
    std::tie(r->s, r->holds, r->json, r->csv, r->junit, r->attributes, r->boxes, films, references, r->times,
        r->threads, r->stages) = state;
    for (const nb::handle entry : films) {
        const nb::tuple fields = nb::cast<nb::tuple>(entry);
        const nb::dict planes = nb::cast<nb::dict>(fields[4]);
        auto& [key, film] = r->films.emplace_back();
        key = {nb::cast<std::string>(fields[0]), nb::cast<std::uint64_t>(fields[1]), nb::cast<double>(fields[2]),
            nb::cast<std::uint32_t>(fields[3])};
        film.n = key.n;
        for (const auto& [name, values] : film_planes) restore_plane(planes, name, values, film);
        for (const auto& [name, values] : film_counts) restore_plane(planes, name, values, film);
    }
    restore_references(nb::cast<nb::list>(references), r->references);
}

/// What a run has done so far.
struct RunSoFar {
    RunPlan plan;
    Engine engine;
    std::optional<Prepared> prepared;
    std::vector<JobResult> results;
};

/// What is computed beside the films.
struct Beside {
    bool references = true, studies = false;
};

/// The wall-clock seconds of a job: the median over so many executions, of which the first is given.
double median_seconds(const RunSoFar& run, const Job& job, double first, int repeats, ProgressMonitor& monitor) {
    std::vector<double> seconds = {first};
    for (int k = 1; k < repeats; ++k) {
        monitor.check();
        seconds.push_back(execute(run.plan, *run.prepared, job, run.engine, monitor, false).seconds);
    }
    return quantile(std::move(seconds), 0.5);
}

/// The result of the seeds of which every job is done, without studies; empty if there is none.
std::optional<RunResult> finished_seeds(const Experiment& experiment, RunSoFar& run) {
    std::erase_if(run.results, [](const JobResult& r) { return r.stopped; });
    int seeds = 0;
    for (const std::uint32_t seed : run.plan.seeds) {
        const auto of_seed = [&](const auto& jobs, auto&& seed_of_job) {
            return std::ranges::count_if(jobs, [&](const auto& j) { return seed_of_job(j) == seed; });
        };
        const auto job_count = of_seed(run.plan.jobs, [](const Job& j) { return j.seed; });
        if (of_seed(run.results, [](const JobResult& r) { return r.job.seed; }) != job_count) break;
        ++seeds;
    }
    if (seeds == 0 || !run.prepared || run.prepared->stopped) return {};
    RunPlan part = plan(experiment, {run.plan.range.first, run.plan.range.first + seeds - 1});
    part.references = run.plan.references;
    std::erase_if(run.results, [&](const JobResult& r) { return !std::ranges::count(part.seeds, r.job.seed); });
    PolledMonitor monitor;
    const Work work_scope(&monitor);
    Measured result =
        collect(part, std::move(*run.prepared), std::move(run.results), run.engine, monitor, {"crescent.run", false});
    return result_of(std::move(result));
}

/// `partial_results` receives the result of the complete seeds if the run is interrupted.
RunResult run_experiment(const Experiment& experiment, int first, int last, int threads, const std::string& isa,
    const Beside& extras, const nb::object& progress, const CallableArms& callables, int repeats,
    nb::typed<nb::list, RunResult> partial_results) {
    PolledMonitor monitor;
    Raised raised(monitor);
    RunResult out;
    const auto [samplers, serial] = samplers_of(callables, raised);
    RunSoFar run;
    bool is_complete = false;
    const auto work = [&] {
        run.plan = plan(experiment, {first, extras.references ? last : first});
        run.plan.references = extras.references;
        run.engine = settled({.threads = serial ? 1 : threads, .isa = isa, .samplers = samplers});
        run.prepared = look(run.plan, run.engine);
        log_warnings(run.plan, *run.prepared, monitor);
        const Stopwatch start;
        add_references(run.plan, *run.prepared, run.engine, monitor);
        monitor.check();
        const double references = start.seconds();
        for (std::size_t k = 0; k < run.plan.jobs.size(); ++k) {
            const Job& job = run.plan.jobs[k];
            monitor.check();
            begin_seed(run.plan, k, run.prepared->geometry_pixels * static_cast<std::uint64_t>(repeats), monitor);
            JobResult result =
                execute(run.plan, *run.prepared, job, run.engine, monitor, job.seed == run.plan.seeds.front());
            result.seconds = median_seconds(run, job, result.seconds, repeats, monitor);
            run.results.push_back(std::move(result));
        }
        monitor.check();
        const double films = start.seconds() - references;
        Measured result = collect(run.plan, std::move(*run.prepared), std::move(run.results), run.engine, monitor,
            {"crescent.run", extras.studies});
        result.timing.stages.insert(result.timing.stages.begin(), {{"references", references}, {"films", films}});
        run.results.clear();
        run.prepared.reset();
        out = result_of(std::move(result));
        is_complete = true;
    };
    try {
        watched(monitor, raised, progress, serial, work);
    } catch (nb::python_error& error) {
        if (!error.matches(PyExc_KeyboardInterrupt)) throw;
        if (is_complete) partial_results.append(nb::cast(std::move(out)));
        else if (std::optional<RunResult> part = finished_seeds(experiment, run))
            partial_results.append(nb::cast(std::move(*part)));
        throw;
    }
    return out;
}

/// Writes metrics.json, metrics.csv, junit.xml, films/*.exr and `attachments`, all at once; only the program writes
/// plates.
void write_folder(
    const RunResult& r, const std::string& folder, const std::vector<std::pair<std::string, nb::bytes>>& attachments) {
    PolledMonitor monitor;
    Raised raised(monitor);
    watched(monitor, raised, nb::none(), true, [&] {
        Staging staging(folder);
        staging.write("metrics.json", r.json);
        staging.write("metrics.csv", r.csv);
        staging.write("junit.xml", r.junit);
        std::map<std::string, std::vector<std::pair<std::string, const Film*>>> files;
        for (const auto& [key, film] : r.films)
            files[film_file(key.arm, key.s, r.s)].emplace_back(fmt::format("n={}", key.n), &film);
        for (const auto& [name, bytes] : attachments)
            staging.write(name, std::span(static_cast<const unsigned char*>(bytes.data()), bytes.size()));
        for (const auto& [name, parts] : files) write_exr(staging.path("films/" + name + ".exr"), parts, r.attributes);
        staging.commit(monitor);
    });
}

/// Returns the metrics whose values are integers.
std::vector<std::string> counting_metrics() {
    std::vector<std::string> out{"pixels", "tail_exceedances"};
    const auto add = [&](std::string_view name, const MetricInfo&, auto value) {
        if constexpr (std::is_same_v<decltype(value), std::uint64_t>) out.emplace_back(name);
    };
    for_each_metric(RegionMetrics{}, add);
    for_each_metric(RunMetrics{}, add);
    return out;
}

/// Returns the experiment with the published values that it names, and with paths that are valid in any working folder:
/// Python changes an experiment by reading its text again.
Experiment settled_paths(Experiment e) {
    const auto absolute = [](std::optional<std::string>& path) {
        if (path) path = std::filesystem::absolute(*path).lexically_normal().string();
    };
    e = with_files(std::move(e));
    absolute(e.published);
    if (e.sky) e.sky->file = std::filesystem::absolute(e.sky->file).lexically_normal().string();
    for (ArmPlan& arm : e.arms) {
        absolute(arm.plugin);
        for (std::optional<std::string>* python : {&arm.python, &arm.combination.weights_python})
            if (*python && !python_file(**python).empty()) absolute(*python);
    }
    return e;
}

/// Parses a text as the file `name`, whose paths are relative to `folder`: also after a change of the working folder.
Experiment parsed_in(const std::string& folder, const std::string& text, const std::string& name,
    const std::vector<std::string>& overrides) {
    const std::string file = (std::filesystem::path(folder) / std::filesystem::path(name).filename()).string();
    const auto rename_place = [&](SourceLocation place) {
        if (place.file == file) place.file = name;
        return place;
    };
    try {
        Experiment e = settled_paths(parse(text, file, overrides));
        e.file = name;
        for (auto& [_, place] : e.places) place = rename_place(place);
        return e;
    } catch (const InputError& error) {
        std::vector<Diagnostic> diagnostics = error.diagnostics();
        for (Diagnostic& diagnostic : diagnostics) diagnostic.location = rename_place(diagnostic.location);
        throw InputError(std::move(diagnostics));
    }
}

using FloatPlane = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

/// HDR-FLIP of each pixel.
nb::object flip_of(const FloatPlane& r0, const FloatPlane& g0, const FloatPlane& b0, const FloatPlane& r,
    const FloatPlane& g, const FloatPlane& b) {
    const auto height = r0.shape(0), width = r0.shape(1);
    const auto image = [&](const FloatPlane& red, const FloatPlane& green, const FloatPlane& blue) {
        for (const FloatPlane* plane : {&red, &green, &blue})
            if (plane->shape(0) != height || plane->shape(1) != width)
                throw nb::value_error("expected six planes of one size");
        return FlipImage{static_cast<int>(width), static_cast<int>(height), {red.data(), red.size()},
            {green.data(), green.size()}, {blue.data(), blue.size()}};
    };
    auto* values = new std::vector<float>(hdr_flip(image(r0, g0, b0), image(r, g, b), flip_pixels_per_degree));
    const nb::capsule owner(values, [](void* p) noexcept { delete static_cast<std::vector<float>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, float>(values->data(), {height, width}, owner));
}

}  // namespace

void add_experiments(nb::module_& m) {
    using namespace nb::literals;
    using Overrides = std::vector<std::string>;
    nb::class_<Experiment>(m, "Experiment", "An experiment, checked.")
        .def_prop_ro("text", &canonical_text)
        .def_prop_ro("file", [](const Experiment& e) { return e.file; })
        .def_prop_ro("hash", [](const Experiment& e) { return fmt::format("{:016x}", crescent::hash(e)); })
        .def("s", [](const Experiment& e) { return e.s(); });
    m.def(
        "load",
        [](const std::string& path, const Overrides& overrides) { return settled_paths(load(path, overrides)); },
        "path"_a, "overrides"_a = Overrides{});
    m.def(
        "parse",
        [](const std::string& text, const std::string& name, const Overrides& overrides, const std::string& folder) {
            return folder.empty() ? settled_paths(parse(text, name, overrides))
                                  : parsed_in(folder, text, name, overrides);
        },
        "text"_a, "name"_a, "overrides"_a = Overrides{}, "folder"_a = "");
    m.def(
        "text_with_overrides",
        [](const std::string& text, const std::string& name, const Overrides& overrides) {
            return text_with_overrides(text, name, overrides);
        },
        "text"_a, "name"_a, "overrides"_a, "A file with these keys changed, without values that other keys decide.");
    m.def("refuse_code", &refuse_code, "experiment"_a);
    m.def(
        "with_arms",
        [](const Experiment& e, const Overrides& arms) {
            Experiment out = settled_paths(parse(canonical_text(e), e.file, arms));
            out.overrides = e.overrides;  // what was changed by the user has columns in metrics.csv
            return out;
        },
        "experiment"_a, "arms"_a, "With these keys of arms, KEY=VALUE each.");
    m.def(
        "nearest", [](const std::string& word, const std::vector<std::string>& valid) { return nearest(word, valid); },
        "word"_a, "valid"_a, "The word of `valid` nearest to `word`; empty where none is near.");
    m.def("schema_text", &schema_text, "The manual of an experiment file.");
    nb::class_<RunResult>(m, "RunResult", "What a run found: texts, films and references.")
        .def_ro("s", &RunResult::s)
        .def_ro("holds", &RunResult::holds)
        .def_ro("json", &RunResult::json)
        .def_ro("csv", &RunResult::csv)
        .def_ro("junit", &RunResult::junit)
        .def_ro("times", &RunResult::times)
        .def_ro("stages", &RunResult::stages)
        .def_ro("boxes", &RunResult::boxes)
        .def_prop_ro("films", [](nb::handle self) { return films_of(self); })
        .def_prop_ro("references", [](nb::handle self) { return references_of(self); })
        .def_ro("threads", &RunResult::threads)
        .def("write", &write_folder, "folder"_a, "more"_a = std::vector<std::pair<std::string, nb::bytes>>{})
        .def("__getstate__", [](nb::handle self) { return state_of(self); })
        .def("__setstate__", &restore);
    m.def("flip", &flip_of, "reference_r"_a, "reference_g"_a, "reference_b"_a, "test_r"_a, "test_g"_a, "test_b"_a,
        "HDR-FLIP of each pixel, linear Rec. 709, at 67.0206 pixels per degree.");
    m.def("counting_metrics", &counting_metrics, "The metrics whose values are whole numbers.");
    m.def(
        "join",
        [](const std::vector<std::string>& parts) {
            const Work work_scope;
            return result_of(join(parts, "crescent.join"));
        },
        "parts"_a);
    m.def(
        "run",
        [](const Experiment& experiment, int first, int last, int threads, const std::string& isa, bool studies,
            bool references, const nb::object& progress, const CallableArms& callables, int repeats,
            nb::typed<nb::list, RunResult> partial_results) {
            return run_experiment(experiment, first, last, threads, isa, {.references = references, .studies = studies},
                progress, callables, repeats, std::move(partial_results));
        },
        "experiment"_a, "first"_a, "last"_a, "threads"_a, "isa"_a, "studies"_a, "references"_a, "progress"_a.none(),
        "callables"_a, "repeats"_a, "kept"_a);
}

}  // namespace crescent::python
