// Reads a metrics.json back into its inputs. Doubles are written in the shortest form that reads back the same, so
// every number is the measured one. The experiment is in the provenance as text; its hash verifies it.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "base/errors.h"
#include "experiment/experiment.h"
#include "experiment/identity.h"
#include "experiment/published.h"
#include "output/stored_json.h"
#include "report/report.h"

namespace crescent {
namespace {

constexpr int most_seeds = 4096;  // as in an experiment

void read(const StoredJson& json, double& to) { to = json.is_null() ? std::nan("") : json.number(); }
void read(const StoredJson& json, std::uint64_t& to) { to = json.get<std::uint64_t>(); }

std::optional<Tail> tail_of(const StoredJson& json) {
    if (!json.contains("tail")) return {};
    const StoredJson tail = json.at("tail");
    return Tail{tail.at("k").number(), tail.at("se").number(), tail.at("exceedances").get<std::uint64_t>()};
}

template <class T, class F> std::vector<T> list_of(const StoredJson& json, F convert) {
    std::vector<T> out;
    for (const StoredJson& item : json.entries()) out.push_back(convert(item));
    return out;
}

RunMetrics run_of(const StoredJson& json) {
    RunMetrics run;
    run.key = {.arm = json.at("arm").get<std::string>(),
        .n = json.at("n").get<std::uint64_t>(),
        .s = json.at("s").number(),
        .seed = json.at("seed").get<std::uint32_t>()};
#define CRESCENT_READ(name, Type) read(json.at(#name), to.name);
    const auto frame = [&](RunMetrics& to) { CRESCENT_FRAME_METRICS(CRESCENT_READ) };
    frame(run);
    for (const auto& [name, region] : json.at("regions").items()) {
        RegionMetrics m;
        m.region = name;
        m.pixels = region.at("pixels").get<std::uint64_t>();
        m.tail = tail_of(region);
        const auto metrics = [](const StoredJson& json, RegionMetrics& to) { CRESCENT_REGION_METRICS(CRESCENT_READ) };
        metrics(region, m);
        if (region.contains("flip")) m.flip = region.at("flip").number();
        if (region.contains("mse")) {
            m.mse = region.at("mse").number();
            m.reference_error = region.at("reference_error").number();
            m.mse_error = region.at("mse_error").number();
        }
        run.regions.push_back(std::move(m));
    }
#undef CRESCENT_READ
    return run;
}

FurnaceResult furnace_of(const StoredJson& json) {
    FurnaceResult out;
    out.name = json.at("name").get<std::string>();
    out.arm = json.at("arm").get<std::string>();
    out.part = json.at("part").get<std::string>();
    out.n = json.at("n").get<std::uint64_t>();
    out.measured = json.at("measured").number();
    out.expected = json.at("expected").number();
    out.tail = tail_of(json);
    if (!out.tail || !out.tail->heavy()) out.se = json.at("se").number();
    out.bad = json.at("bad").get<std::uint64_t>();
    out.published = json.at("published").optional_number();
    return out;
}

ReferenceQuality reference_of(const StoredJson& json) {
    ReferenceQuality out;
    out.s = json.at("s").number();
    out.region = json.at("region").get<std::string>();
    out.error_share = json.at("error_share").number();
    if (json.contains("paired_error")) {
        out.paired_error = json.at("paired_error").number();
        return out;
    }
    out.rms_difference = json.at("rms_difference").optional_number();
    out.rms_standard_error = json.at("rms_standard_error").optional_number();
    out.quadrature_error = json.at("quadrature_error").optional_number();
    out.max_relative_rmse_change = json.at("rmse_unlike").optional_number();
    return out;
}

AssertionResult assertion_of(const StoredJson& json) {
    AssertionResult out;
    out.name = json.at("name").get<std::string>();
    out.pass = json.at("pass").get<bool>();
    out.measured = json.at("measured").number();
    out.bound = json.at("bound").number();
    out.op = json.at("op").get<std::string>();
    out.text = json.at("text").get<std::string>();
    out.cannot_fail = json.value("cannot_fail", false);
    out.skipped = json.value("skipped", "");
    return out;
}

Evidence evidence_of(const StoredJson& json) {
    Evidence e;
    e.s = json.at("s").number();
    e.rho_d = json.at("rho_d").number();
    e.rho_s = json.at("rho_s").number();
    e.expected = json.at("expected").number();
    e.alpha = json.at("alpha").number();
    e.furnace = list_of<FurnaceQuantiles>(json.at("furnace"), [](const StoredJson& q) {
        return FurnaceQuantiles{q.at("arithmetic").get<std::string>(), q.at("u_bits").get<int>(),
            q.at("n").get<std::uint64_t>(), q.at("q05").number(), q.at("q25").number(), q.at("median").number(),
            q.at("q75").number(), q.at("q95").number()};
    });
    e.caps = list_of<FurnaceCap>(
        json.at("caps"), [](const StoredJson& c) { return FurnaceCap{c.at("u_bits").get<int>(), c.at("y").number()}; });
    e.lost = list_of<LostSupport>(json.at("lost"), [](const StoredJson& l) {
        return LostSupport{
            l.at("theta_R_deg").number(), l.at("measured").number(), l.at("se").number(), l.at("theory").number()};
    });
    e.rejections = list_of<FalseRejection>(json.at("rejections"), [](const StoredJson& r) {
        return FalseRejection{r.at("s").number(), r.at("k").number(), r.at("n").get<std::uint64_t>(),
            r.at("runs").get<int>(), r.at("rejected").get<int>(), r.at("low").number(), r.at("high").number()};
    });
    return e;
}

Provenance provenance_of(const StoredJson& json) {
    Provenance p;
    p.version = json.at("version").get<std::string>();
    p.commit = json.at("commit").get<std::string>();
    p.compiler = json.at("compiler").get<std::string>();
    p.backend = json.at("instrument").get<std::string>();
    p.command = json.at("command").get<std::string>();
    const StoredJson experiment = json.at("experiment");
    p.experiment_file = experiment.at("file").get<std::string>();
    p.experiment_hash = experiment.at("hash").get<std::string>();
    p.experiment_text = experiment.at("text").get<std::string>();
    p.seeds = json.at("seeds").get<std::vector<std::uint32_t>>();
    p.series = json.at("series").at("of").get<int>();
    if (p.series < 1 || p.series > most_seeds)
        json.at("series").at("of").refuse(fmt::format("expected a series of 1 to {} seeds", most_seeds));
    const auto missing = json.at("series").value("missing", std::vector<int>{});
    for (int place = 1; place <= p.series; ++place)
        if (std::ranges::find(missing, place) == missing.end()) p.places.push_back(place);
    if (json.contains("instrument_details"))
        for (const auto& [what, message] : json.at("instrument_details").items())
            p.backend_details.emplace_back(what, message.get<std::string>());
    return p;
}

Experiment experiment_of(const Provenance& p, const StoredJson& json, const std::string& name) {
    Experiment e = parse(p.experiment_text, std::filesystem::path(name).filename().string());
    e.file = p.experiment_file;
    e.overrides = json.value("set", std::vector<std::string>{});
    if (json.contains("published")) e.figures = parse_published(json.at("published").value().dump(), name);
    if (fmt::format("{:016x}", hash(e)) != p.experiment_hash)
        throw InputError({name, 0, 0},
            "the experiment in it does not have the stated hash; expected the file as it was "
            "written, by this version of crescent");
    e.seed = p.seeds.at(0);
    e.seeds = static_cast<int>(p.seeds.size());
    return e;
}

MetricsFile file_of(const StoredJson& json, const std::string& name) {
    if (json.at("format").get<std::string>() != "crescent metrics 2")
        throw InputError({name, 0, 0}, "expected the format 'crescent metrics 2'");
    MetricsFile out;
    out.provenance = provenance_of(json.at("provenance"));
    out.experiment = experiment_of(out.provenance, json.at("provenance").at("experiment"), name);
    Metrics& m = out.metrics;
    m.runs = list_of<RunMetrics>(json.at("runs"), run_of);
    m.furnaces = list_of<FurnaceResult>(json.at("furnace"), furnace_of);
    m.references = list_of<ReferenceQuality>(json.at("references"), reference_of);
    m.assertions = list_of<AssertionResult>(json.at("assertions"), assertion_of);
    m.shape_pixels = json.at("shape_pixels").get<std::map<std::string, std::uint64_t>>();
    m.film_hashes = json.at("films").get<std::map<std::string, std::string>>();
    m.geometry_pixels = json.at("geometry_pixels").get<std::uint64_t>();
    m.has_studies = !json.contains("studies") || json.at("studies").get<bool>();
    out.evidence = evidence_of(json.at("evidence"));
    return out;
}

}  // namespace

MetricsFile read_metrics(const std::string& text, const std::string& name) {
    return metrics_from_json(parse_json(text, name, "the metrics.json of a run"), name);
}

MetricsFile metrics_from_json(const Json& json, const std::string& name) {
    try {
        return file_of(json, name);
    } catch (const StoredJsonError& error) {
        throw InputError({name, 0, 0}, fmt::format("expected the metrics.json of a run: {}", error.what()));
    } catch (const std::out_of_range&) {
        throw InputError({name, 0, 0}, "expected the metrics.json of a run: it has no seeds");
    }
}

void check_runs(const MetricsFile& file, const std::string& name) {
    const Experiment& e = file.experiment;
    for (const RunMetrics& run : file.metrics.runs) {
        const ArmPlan* arm = e.find_arm(run.key.arm);
        const bool is_planned = arm && std::ranges::find(arm->n, run.key.n) != arm->n.end() && std::isfinite(run.key.s);
        if (!is_planned || !std::ranges::equal(run.regions, e.regions, {}, &RegionMetrics::region, &Region::name))
            throw InputError({name, 0, 0},
                fmt::format("the run {} is not one of the experiment in it, or has other regions", to_string(run.key)));
    }
}

}  // namespace crescent
