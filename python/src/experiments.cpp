// Experiments and runs, for crescent/_run.py: an experiment file or text in, films and numbers out, all in memory.
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "doors.h"
#include "watched.h"

namespace crescent::python {

namespace {

/// Rows bottom-up, [height, width]; the array keeps `owner` alive and shares its memory.
template <class T> nb::object plane(const std::vector<T>& values, int width, int height, nb::handle owner) {
    const std::size_t shape[] = {static_cast<std::size_t>(height), static_cast<std::size_t>(width)};
    return nb::cast(nb::ndarray<nb::numpy, const T>(values.data(), 2, shape, owner));
}

nb::dict planes_of(const Film& f, nb::handle owner) {
    nb::dict out;
    const std::pair<const char*, const std::vector<float>*> all[] = {{"r", &f.r}, {"g", &f.g}, {"b", &f.b}, {"y", &f.y},
        {"y2", &f.second_moment}, {"var", &f.var}, {"largest", &f.largest}};
    for (const auto& [name, values] : all) out[name] = plane(*values, f.width, f.height, owner);
    out["horizon"] = plane(f.horizon, f.width, f.height, owner);
    out["hits"] = plane(f.light_hits, f.width, f.height, owner);
    return out;
}

nb::dict planes_of(const ReferenceFilm& f, nb::handle owner) {
    nb::dict out;
    const std::pair<const char*, const std::vector<float>*> all[] = {
        {"r", &f.r}, {"g", &f.g}, {"b", &f.b}, {"y", &f.y}, {"error", &f.error}};
    for (const auto& [name, values] : all) out[name] = plane(*values, f.width, f.height, owner);
    return out;
}

using Planes = nb::typed<nb::dict, std::string, nb::any>;
using FilmList = nb::typed<nb::list, nb::typed<nb::tuple, std::string, int, double, int, Planes>>;
using ReferenceList = nb::typed<nb::list, nb::typed<nb::tuple, double, Planes>>;

/// Every film of the run with its key, (arm, n, s, seed, planes).
FilmList films_of(nb::handle self) {
    const Measured& m = nb::cast<const Measured&>(self);
    nb::list out;
    for (const auto& [key, film] : m.films)
        out.append(nb::make_tuple(key.arm, key.n, key.s, key.seed, planes_of(film, self)));
    return out;
}

/// The references that the meters use, (s, planes).
ReferenceList references_of(nb::handle self) {
    const Measured& m = nb::cast<const Measured&>(self);
    nb::list out;
    for (const ReferenceFilm& film : m.quadrature) out.append(nb::make_tuple(film.s, planes_of(film, self)));
    return out;
}

std::shared_ptr<Measured> measured(const Experiment& experiment, int first, int last, int threads,
    const std::string& isa, bool studies, const nb::object& progress) {
    PolledMonitor monitor;
    Raised raised(monitor);
    const auto out = std::make_shared<Measured>();
    watched(monitor, raised, progress, false, [&] {
        const RunPlan what = plan(experiment, {first, last});
        const Engine engine = settled({.threads = threads, .isa = isa, .instrument = nullptr});
        Prepared prepared = prepare(what, engine, monitor);
        std::vector<JobResult> results;
        for (const Job& job : what.jobs) {
            monitor.check();
            results.push_back(execute(what, prepared, job, engine, monitor, job.seed == what.seeds.front()));
        }
        monitor.check();
        *out = collect(what, std::move(prepared), std::move(results), engine, monitor, {"crescent.run", studies});
        monitor.check();
    });
    return out;
}

ReportInputs inputs_of(const Measured& m) { return {m.experiment, m.metrics, m.evidence, m.provenance, m.plates}; }

/// metrics.json, metrics.csv, junit.xml and films/*.exr appear as one; plates and report are the program's.
void write_folder(const Measured& m, const std::string& folder) {
    const nb::gil_scoped_release free;
    ProgressMonitor monitor;
    Staging staging(folder);
    staging.write("metrics.json", metrics_json(inputs_of(m)));
    staging.write("metrics.csv", metrics_csv(inputs_of(m)));
    staging.write("junit.xml", junit_xml(inputs_of(m)));
    const Provenance& p = m.provenance;
    const Attributes attributes = {{"crescent", p.version + " " + p.commit}, {"compiler", p.compiler},
        {"experiment", p.experiment_file + " " + p.experiment_hash}, {"instrument", p.instrument}};
    std::map<std::string, std::vector<std::pair<std::string, const Film*>>> files;
    for (const auto& [key, film] : m.films)
        files[film_file(key.arm, key.s, m.experiment.s())].emplace_back(fmt::format("n={}", key.n), &film);
    for (const auto& [name, parts] : files) write_exr(staging.path("films/" + name + ".exr"), parts, attributes);
    staging.commit(monitor);
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
    m.def("load", &load, "path"_a, "overrides"_a = Overrides{});
    m.def(
        "parse",
        [](const std::string& text, const std::string& name, const Overrides& overrides) {
            return parse(text, name, overrides);
        },
        "text"_a, "name"_a, "overrides"_a = Overrides{});
    m.def("schema_text", &schema_text, "The manual of an experiment file.");
    nb::class_<Measured>(m, "Measured", "Everything that a run measured.")
        .def_prop_ro("films", [](nb::handle self) { return films_of(self); })
        .def_prop_ro("references", [](nb::handle self) { return references_of(self); })
        .def_prop_ro("holds", [](const Measured& x) { return x.metrics.all_hold(); })
        .def("json", [](const Measured& x) { return metrics_json(inputs_of(x)); })
        .def("csv", [](const Measured& x) { return metrics_csv(inputs_of(x)); })
        .def("junit", [](const Measured& x) { return junit_xml(inputs_of(x)); })
        .def("write", &write_folder, "folder"_a);
    m.def(
        "join",
        [](const std::vector<std::string>& parts) {
            const nb::gil_scoped_release free;
            auto joined = std::make_shared<Measured>(join(parts, "crescent.join"));
            const double s = joined->experiment.s();
            return std::pair(std::move(joined), s);
        },
        "parts"_a);
    m.def(
        "run", &measured, "experiment"_a, "first"_a, "last"_a, "threads"_a, "isa"_a, "studies"_a, "progress"_a.none());
}

}  // namespace crescent::python
