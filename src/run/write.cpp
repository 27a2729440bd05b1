// EXR files are written in parallel with the drawing of plates; then plates, the assertions on them, metrics.json,
// metrics.csv, junit.xml and report.html, and last timing.json, with the date. Times in seconds.
#include "run/write.h"

#include <algorithm>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/files.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/text.h"
#include "experiment/experiment.h"
#include "metrics/assertions.h"
#include "metrics/metrics.h"
#include "report/plates/canvas.h"
#include "report/plates/plates.h"
#include "report/plates/sheet.h"
#include "run/collect.h"
#include "run/plan.h"
#include "run/version.h"

namespace crescent {

namespace {

/// Returns "2026-01-31T12:00:00Z"; "unknown" if the clock has no date, as at the ends of 64 bits.
std::string utc_date() {
    const std::time_t now = std::time(nullptr);
    std::tm date{};
    return gmtime_r(&now, &date) ? fmt::format("{:%FT%TZ}", date) : "unknown";
}

PlateInputs plate_inputs(const Measured& m) {
    return {m.experiment, m.metrics, m.shapes, [&m](const RunKey& key) { return m.film(key); },
        [&m](double s) { return m.reference(s); }, m.provenance.backend, m.experiment.theme.value_or(Theme::dark),
        [&m](const std::string& arm) { return external_of(m.outside, arm); }};
}

std::vector<unsigned char> draw(const PlatePlan& plan, const Measured& m, Attributes text) {
    const PlateInputs in = plate_inputs(m);
    text.emplace_back("plate", plan.name);
    return encode_png(draw_plate(plan, in), text);
}

/// One file per arm and exponent, sample counts as parts.
void write_films(const Measured& m, Staging& staging, const ProgressMonitor& monitor) {
    std::vector<std::pair<std::string, std::vector<std::pair<std::string, const Film*>>>> files;
    for (const auto& [key, film] : m.films) {
        const std::string name = film_file(key.arm, key.s, m.experiment.s());
        if (files.empty() || files.back().first != name) files.push_back({name, {}});
        files.back().second.emplace_back(fmt::format("n={}", key.n), &film);
    }
    for (const auto& [name, parts] : files) {
        write_exr(staging.path("films/" + name + ".exr"), parts, attributes_of(m));
        monitor.check();
    }
}

void write_references(const Measured& m, Staging& staging) {
    std::vector<std::pair<std::string, const ReferenceFilm*>> parts;
    for (const ReferenceFilm& film : m.quadrature) parts.emplace_back(fmt::format("quadrature s={}", film.s), &film);
    for (const ReferenceFilm& film : m.monte_carlo) parts.emplace_back(fmt::format("note s={}", film.s), &film);
    for (const ReferenceFilm& film : m.paired) parts.emplace_back(fmt::format("paired s={}", film.s), &film);
    if (!parts.empty()) write_exr(staging.path(fmt::format("films/{}.exr", reference_file)), parts, attributes_of(m));
}

/// Writes each as PNG; those that consist only of lines as SVG too.
void write_plates(const Measured& m, Staging& staging) {
    for (const auto& [name, png] : m.plates) staging.write("plates/" + name + ".png", png);
    const std::vector<PlatePlan>& plans = m.experiment.plates;
    std::vector<std::string> svg(plans.size());
    parallel_for(
        std::size_t{0}, plans.size(), [&](std::size_t k) { svg[k] = draw_plate_svg(plans[k], plate_inputs(m)); });
    for (std::size_t k = 0; k < plans.size(); ++k)
        if (!svg[k].empty()) staging.write("plates/" + plans[k].name + ".svg", svg[k]);
}

/// The experiment's own assertions come first; those of the back end are unchanged.
void check_plates(Measured& m) {
    PlateBytes bytes;
    for (const auto& [name, png] : m.plates) bytes[name] = png.size();
    std::ranges::move(evaluate_assertions(m.experiment, m.metrics, bytes), m.metrics.assertions.begin());
}

void write_reports(const Measured& m, Staging& staging, const OutputParts& parts) {
    const ReportInputs in = report_inputs(m);
    if (parts.metrics) {
        staging.write("metrics.json", metrics_json(in));
        staging.write("metrics.csv", metrics_csv(in));
        staging.write("junit.xml", junit_xml(in));
    }
    if (parts.report) staging.write("report.html", report_html(in));
}

}  // namespace

OutputParts output_parts(const std::string& words) {
    OutputParts out{.metrics = false, .films = false, .plates = false, .report = false};
    const std::pair<const char*, bool*> parts[] = {
        {"metrics", &out.metrics}, {"films", &out.films}, {"plates", &out.plates}, {"report", &out.report}};
    std::vector<std::string> names;
    for (const auto& [name, part] : parts) names.emplace_back(name);
    for (std::size_t begin = 0; begin <= words.size();) {
        const std::size_t end = std::min(words.find(',', begin), words.size());
        const std::string word = words.substr(begin, end - begin);
        const auto match = std::ranges::find(names, word);
        if (match == names.end())
            throw InputError({"--only " + words, 0, 0},
                fmt::format("expected metrics, films, plates or report, several with commas between, not '{}'{}", word,
                    did_you_mean(word, names)));
        *parts[match - names.begin()].second = true;
        begin = end + 1;
    }
    return out;
}

Attributes attributes_of(const Measured& m) {
    const Provenance& p = m.provenance;
    return {{"crescent", p.version + " " + p.commit}, {"compiler", p.compiler},
        {"experiment", p.experiment_file + " " + p.experiment_hash}, {"command", p.command}, {"instrument", p.backend},
        {"seed", std::to_string(m.experiment.seed)}};
}

Plates draw_plates(const Measured& m, const ProgressMonitor& monitor) {
    const std::vector<PlatePlan>& plans = m.experiment.plates;
    std::vector<std::vector<unsigned char>> bytes(plans.size());
    parallel_for(std::size_t{0}, plans.size(), [&](std::size_t k) {
        monitor.check();
        bytes[k] = draw(plans[k], m, attributes_of(m));
    });
    Plates out;
    for (std::size_t k = 0; k < plans.size(); ++k) out[plans[k].name] = std::move(bytes[k]);
    return out;
}

std::vector<std::string> outputs_of(const RunPlan& plan, const OutputParts& parts) {
    std::vector<std::string> out = {"timing.json"};
    if (parts.metrics) out.insert(out.end(), {"metrics.json", "metrics.csv", "junit.xml"});
    if (parts.report) out.push_back("report.html");
    if (parts.films)
        for (const Job& job : plan.jobs)
            out.push_back("films/" + film_file(job.arm, job.s, plan.experiment.s()) + ".exr");
    if (parts.films) out.push_back(fmt::format("films/{}.exr", reference_file));
    if (parts.plates)
        for (const PlatePlan& plate : plan.experiment.plates) out.push_back("plates/" + plate.name + ".png");
    return out;
}

ReportInputs report_inputs(const Measured& m) { return {m.experiment, m.metrics, m.evidence, m.provenance, m.plates}; }

void write(Measured& m, Staging& staging, ProgressMonitor& monitor, const OutputParts& parts) {
    const Stopwatch start;
    side_by_side(
        [&] {
            if (!parts.films) return;
            write_films(m, staging, monitor);
            write_references(m, staging);
        },
        [&] {
            if (parts.draws()) m.plates = draw_plates(m, monitor);
        });
    if (parts.plates) write_plates(m, staging);
    m.timing.stages.emplace_back("plates and films on disk", start.seconds());
    if (parts.draws()) check_plates(m);
    const Stopwatch report;
    write_reports(m, staging, parts);
    m.timing.stages.emplace_back("report", report.seconds());
    m.timing.total_s += start.seconds();
    m.timing.date = utc_date();
    m.timing.host_cpu = host_cpu();
    staging.write("timing.json", timing_json(m.timing, m.provenance));
    monitor.check();
}

bool write(Measured& m, const std::string& folder, ProgressMonitor& monitor, const OutputParts& parts, int threads) {
    Staging staging(folder);
    const bool is_complete =
        unless_stopped(threads > 0 ? threads : usable_threads(), monitor, [&] { write(m, staging, monitor, parts); });
    if (is_complete) staging.commit(monitor);
    return is_complete;
}

// ---- The steps of a run without its jobs: what the camera sees, the reference, one plate.

namespace {

/// Returns the scene and references of the experiment without its arms.
Experiment without_arms(Experiment e) {
    e.arms.clear();
    e.exponent.reset();
    e.furnaces.clear();
    e.published.reset();
    e.seeds = 1;
    if (e.reference.kind == ReferenceKind::note) e.reference.kind = ReferenceKind::quadrature;
    e.reference.monte_carlo = false;
    if (e.reference.kind == ReferenceKind::paired) e.reference.n = std::min<std::uint64_t>(e.reference.n, 16);
    return e;
}

}  // namespace

std::vector<unsigned char> preview(const Experiment& experiment, const Engine& engine, ProgressMonitor& monitor) {
    check_font(experiment);
    RunPlan preview_plan = plan(without_arms(experiment));
    preview_plan.exponents = {experiment.s()};
    const Engine settled_engine = settled(engine);
    const Prepared prepared = prepare(preview_plan, settled_engine, monitor);
    monitor.check();
    const Metrics empty_metrics;
    const PlateInputs in{preview_plan.experiment, empty_metrics, prepared.shapes, [](const RunKey&) { return nullptr; },
        [&](double s) { return reference_of(preview_plan.experiment, prepared, s); }, settled_engine.backend->name(),
        experiment.theme.value_or(Theme::dark)};
    const Provenance p = provenance_of(preview_plan, *settled_engine.backend, "");
    return encode_png(draw_preview(in), {{"crescent", p.version + " " + p.commit}, {"plate", "preview"}});
}

// ---- In a file of its own, so that a program which draws no plates is not linked with the drawing code.

void check_font(const Experiment& experiment) {
    if (!experiment.plates.empty()) const plates::Canvas font(16, 16, plates::ground);
}

}  // namespace crescent
