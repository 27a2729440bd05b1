// metrics.json: every number of a run, as docs/metrics.schema.json describes it. Units are those of metrics/metrics.h.
// The same run gives the same bytes: keys in a fixed order, doubles in the shortest form that reads back the same.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "experiment/experiment.h"
#include "experiment/overrides.h"
#include "experiment/published.h"
#include "output/format.h"
#include "output/junit.h"
#include "report/report.h"

namespace crescent {
namespace {

Json optional_number(const std::optional<double>& x) { return x ? number(*x) : Json(nullptr); }

Json tail_json(const Tail& tail) {
    return {{"k", number(tail.k)}, {"se", number(tail.se)}, {"exceedances", tail.exceedances}};
}

/// An RMSE whose estimated square is below 0 is not a number: null. Elsewhere NaN is an invalid number and stays
/// visible.
Json number_or_null(double x, bool paired) { return paired && std::isnan(x) ? Json(nullptr) : number(x); }

Json json_of(double x) { return number(x); }
Json json_of(std::uint64_t count) { return count; }

/// Adds every metric of a region or of the frame.
template <class Of> void add_metrics(Json& out, const Of& metrics) {
    for_each_metric(metrics,
        [&](std::string_view name, const MetricInfo&, auto value) { out[std::string(name)] = json_of(value); });
}

Json run_json(const RunMetrics& run, bool paired) {
    Json regions = Json::object();
    for (const RegionMetrics& r : run.regions) {
        Json& entry = regions[r.region] = Json::object();
        add_metrics(entry, r);
        entry["pixels"] = r.pixels;
        if (r.has_flip()) entry["flip"] = number(r.flip);
        if (r.tail) entry["tail"] = tail_json(*r.tail);
        if (!r.is_paired()) continue;
        entry["rmse"] = number_or_null(r.rmse, true);
        entry["mse"] = number(r.mse);
        entry["mse_error"] = number(r.mse_error);
        entry["mse_interval"] = numbers({r.mse_low(), r.mse_high()});
        entry["reference_error"] = number(r.reference_error);
    }
    Json out = {{"arm", run.key.arm}, {"n", run.key.n}, {"s", number(run.key.s)}, {"seed", run.key.seed},
        {"regions", std::move(regions)}};
    add_metrics(out, run);
    out["rmse_frame"] = number_or_null(run.rmse_frame, paired);
    return out;
}

Json interval_json(const Band& band, bool paired) {
    if (band.heavy) return heavy_tail;
    if (band.seeds < 2) return nullptr;
    return Json::array({number_or_null(band.q05, paired), number_or_null(band.q95, paired)});
}

Json band_json(const SeedSpread& b, bool paired) {
    return {{"arm", b.key.arm}, {"n", b.key.n}, {"s", number(b.key.s)}, {"metric", b.metric},
        {"published", optional_number(b.published)}, {"measured", number_or_null(b.measured, paired)},
        {"median", number_or_null(b.band.median, paired)}, {"q05", number_or_null(b.band.q05, paired)},
        {"q95", number_or_null(b.band.q95, paired)}, {"seeds", b.band.seeds},
        {"interval", interval_json(b.band, paired)}, {"published_rank", optional_number(b.published_rank)}};
}

Json ladder_json(const Ladder& l, bool paired) {
    Json rmse = Json::array();
    for (const double x : l.rmse) rmse.push_back(number_or_null(x, paired));
    Json interval = heavy_tail;
    if (!l.heavy)
        interval = std::isfinite(l.low) && std::isfinite(l.high) ? Json::array({number(l.low), number(l.high)})
                                                                 : Json(nullptr);
    return {{"arm", l.arm}, {"region", l.region}, {"s", number(l.s)}, {"n", l.n}, {"rmse", std::move(rmse)},
        {"slope", number_or_null(l.slope, paired)}, {"low", number_or_null(l.low, paired)},
        {"high", number_or_null(l.high, paired)}, {"interval", std::move(interval)}};
}

Json furnace_json(const FurnaceResult& f) {
    Json out = {{"name", f.name}, {"arm", f.arm}, {"part", f.part}, {"n", f.n}, {"measured", number(f.measured)},
        {"expected", number(f.expected)}, {"se", f.tail && f.tail->heavy() ? Json(heavy_tail) : number(f.se)},
        {"bad", f.bad}, {"published", optional_number(f.published)}};
    if (f.tail) out["tail"] = tail_json(*f.tail);
    return out;
}

Json reference_json(const ReferenceQuality& r) {
    if (r.paired_error)
        return {{"s", number(r.s)}, {"region", r.region}, {"paired_error", number(*r.paired_error)},
            {"error_share", number(r.error_share)}};
    return {{"s", number(r.s)}, {"region", r.region}, {"rms_difference", optional_number(r.rms_difference)},
        {"rms_standard_error", optional_number(r.rms_standard_error)},
        {"quadrature_error", optional_number(r.quadrature_error)},
        {"rmse_unlike", optional_number(r.max_relative_rmse_change)}, {"error_share", number(r.error_share)}};
}

Json assertion_json(const AssertionResult& a) {
    Json out = {{"name", a.name}, {"pass", a.pass}, {"measured", number(a.measured)}, {"bound", number(a.bound)},
        {"op", a.op}, {"text", a.text}};
    if (a.cannot_fail) out["cannot_fail"] = true;
    if (!a.skipped.empty()) out["skipped"] = a.skipped;
    return out;
}

Json quantiles_json(const FurnaceQuantiles& q) {
    return {{"arithmetic", q.arithmetic}, {"u_bits", q.u_bits}, {"n", q.n}, {"q05", number(q.q05)},
        {"q25", number(q.q25)}, {"median", number(q.median)}, {"q75", number(q.q75)}, {"q95", number(q.q95)}};
}

Json cap_json(const FurnaceCap& c) { return {{"u_bits", c.u_bits}, {"y", number(c.y)}}; }

Json lost_json(const LostSupport& l) {
    return {{"theta_R_deg", number(l.theta_R_deg)}, {"measured", number(l.measured)}, {"se", number(l.se)},
        {"theory", number(l.theory)}};
}

Json rejection_json(const FalseRejection& r) {
    return {{"s", number(r.s)}, {"k", number(r.k)}, {"n", r.n}, {"runs", r.runs}, {"rejected", r.rejected},
        {"low", number(r.low)}, {"high", number(r.high)}};
}

template <class T, class F> Json list(const std::vector<T>& items, F convert) {
    Json out = Json::array();
    for (const T& x : items) out.push_back(convert(x));
    return out;
}

Json evidence_json(const Evidence& e) {
    return {{"s", number(e.s)}, {"rho_d", number(e.rho_d)}, {"rho_s", number(e.rho_s)},
        {"expected", number(e.expected)}, {"alpha", number(e.alpha)}, {"furnace", list(e.furnace, quantiles_json)},
        {"caps", list(e.caps, cap_json)}, {"lost", list(e.lost, lost_json)},
        {"rejections", list(e.rejections, rejection_json)}};
}

/// In the form of a file of published values.
Json published_json(const Published& p) {
    Json out = {{"source", p.source}, {"runs", Json::array()}, {"furnaces", Json::object()}};
    if (p.seed) out["seed"] = *p.seed;
    for (const auto& [key, value] : p.runs) {
        const auto& [arm, n, s, metric] = key;
        out["runs"].push_back({{"arm", arm}, {"n", n}, {"s", s}, {metric, value}});
    }
    for (const auto& [name, value] : p.furnaces) out["furnaces"][name] = value;
    return out;
}

/// Returns the experiment in full, so that parts of its seeds can be joined without its files.
Json experiment_json(const ReportInputs& in) {
    Json out = {{"file", in.provenance.experiment_file}, {"hash", in.provenance.experiment_hash}};
    if (in.provenance.experiment_text.empty()) return out;
    out["text"] = in.provenance.experiment_text;
    if (!in.experiment.overrides.empty()) out["set"] = in.experiment.overrides;
    if (in.experiment.figures) out["published"] = published_json(*in.experiment.figures);
    return out;
}

}  // namespace

std::vector<int> Provenance::missing() const {
    std::vector<int> out;
    for (int place = 1; place <= series; ++place)
        if (std::ranges::find(places, place) == places.end()) out.push_back(place);
    return out;
}

std::string ranges_text(const std::vector<int>& ascending) {
    std::string out;
    for (std::size_t k = 0; k < ascending.size();) {
        std::size_t last = k;
        while (last + 1 < ascending.size() && ascending[last + 1] == ascending[last] + 1) ++last;
        out += (out.empty() ? "" : ", ") + std::to_string(ascending[k]);
        if (last > k) out += " to " + std::to_string(ascending[last]);
        k = last + 1;
    }
    return out;
}

Json provenance_json(const Provenance& p) {
    Json out = {{"version", p.version}, {"commit", p.commit}, {"compiler", p.compiler},
        {"experiment", {{"file", p.experiment_file}, {"hash", p.experiment_hash}}}, {"seeds", p.seeds},
        {"instrument", p.backend}, {"command", p.command}};
    if (p.series > 0 && !p.places.empty()) {
        out["series"] = {{"first", p.places.front()}, {"last", p.places.back()}, {"of", p.series}};
        if (const std::vector<int> missing = p.missing(); !missing.empty()) out["series"]["missing"] = missing;
    }
    for (const auto& [what, message] : p.backend_details) out["instrument_details"][what] = message;
    return out;
}

std::string metrics_json(const ReportInputs& in) {
    const Metrics& m = in.metrics;
    const bool paired = in.experiment.reference.kind == ReferenceKind::paired;
    const auto convert_band = [&](const SeedSpread& b) { return band_json(b, paired && b.metric.starts_with("rmse")); };
    Json provenance = provenance_json(in.provenance);
    provenance["experiment"] = experiment_json(in);
    Json out = {{"format", "crescent metrics 2"}, {"title", in.experiment.title},
        {"geometry_pixels", m.geometry_pixels}, {"shape_pixels", m.shape_pixels},
        {"runs", list(m.runs, [&](const RunMetrics& run) { return run_json(run, paired); })},
        {"bands", list(m.bands, convert_band)},
        {"ladders", list(m.ladders, [&](const Ladder& l) { return ladder_json(l, paired); })},
        {"furnace", list(m.furnaces, furnace_json)}, {"references", list(m.references, reference_json)},
        {"assertions", list(m.assertions, assertion_json)}, {"films", m.film_hashes},
        {"evidence", evidence_json(in.evidence)}, {"provenance", std::move(provenance)}};
    if (!m.has_studies) out["studies"] = false;
    return text(out);
}

// ---- metrics.csv: every run in long form, one number per row, in RFC 4180 (CRLF, quotes doubled). The region is empty
// for the metrics of the whole frame; a column follows for each key that --set gave, with the name given to --set,
// `set.seed` and `set.n` for the two keys that are columns already. Units are those of metrics/metrics.h.

namespace {

constexpr std::array<std::string_view, 7> fixed_columns = {"arm", "n", "s", "seed", "metric", "region", "value"};

struct Rows {
    std::string out;
    std::string run;  // "arm,n,s,seed,", the same for all rows of a run
    std::string set;  // ",64": a value for each key that --set gave, the same for all rows

    void add(std::string_view metric, std::string_view region, const std::string& value) {
        out += run + csv_field(metric) + "," + csv_field(region) + "," + value + set + "\r\n";
    }
    void add(std::string_view metric, std::string_view region, double value) { add(metric, region, shortest(value)); }
    void add(std::string_view metric, std::string_view region, std::uint64_t value) {
        add(metric, region, std::to_string(value));
    }
};

void add_region(Rows& rows, const RegionMetrics& r) {
    for_each_metric(r, [&](std::string_view name, const MetricInfo&, auto value) { rows.add(name, r.region, value); });
    rows.add("pixels", r.region, r.pixels);
    if (r.has_flip()) rows.add("flip", r.region, r.flip);
    if (r.is_paired()) {
        rows.add("mse", r.region, r.mse);
        rows.add("mse_low", r.region, r.mse_low());
        rows.add("mse_high", r.region, r.mse_high());
        rows.add("reference_error", r.region, r.reference_error);
    }
    if (!r.tail) return;
    rows.add("tail_k", r.region, r.tail->k);
    rows.add("tail_se", r.region, r.tail->se);
    rows.add("tail_exceedances", r.region, std::uint64_t{r.tail->exceedances});
}

/// Returns what --set gave, key by key in the order of first mention, with the last value of each key. The number of
/// seeds is omitted, because each row is of one seed.
std::vector<std::pair<std::string, std::string>> overrides_of(const Experiment& experiment) {
    std::vector<std::pair<std::string, std::string>> out;
    for (const std::string& text : experiment.overrides) {
        const std::size_t equals = end_of_path(text);
        const std::string path = text.substr(0, equals), value = text.substr(equals + 1);
        if (path == "seeds") continue;
        const auto entry = std::ranges::find(out, path, &std::pair<std::string, std::string>::first);
        if (entry == out.end()) out.emplace_back(path, value);
        else entry->second = value;
    }
    return out;
}

/// Returns a key's column: the key as given, unless it would be the second column of its name.
std::string column_of(const std::string& path) {
    return std::ranges::find(fixed_columns, path) == fixed_columns.end() ? path : "set." + path;
}

}  // namespace

std::string metrics_csv(const ReportInputs& in) {
    Rows rows;
    for (const std::string_view name : fixed_columns) rows.out += (rows.out.empty() ? "" : ",") + std::string(name);
    for (const auto& [path, value] : overrides_of(in.experiment)) {
        rows.out += "," + csv_field(column_of(path));
        rows.set += "," + csv_field(value);
    }
    rows.out += "\r\n";
    for (const RunMetrics& run : in.metrics.runs) {
        rows.run = csv_field(run.key.arm) + "," + std::to_string(run.key.n) + "," + shortest(run.key.s) + "," +
            std::to_string(run.key.seed) + ",";
        for (const RegionMetrics& r : run.regions) add_region(rows, r);
        for_each_metric(run, [&](std::string_view name, const MetricInfo&, auto value) { rows.add(name, "", value); });
    }
    return rows.out;
}

// ---- junit.xml: one test case per assertion, for build servers; no times and no dates, so that equal runs give equal
// bytes.

namespace {

TestCase case_of(const AssertionResult& a, const std::string& group) {
    TestCase out{
        .group = group, .name = a.name, .state = TestCase::State::passed, .message = "", .text = "", .seconds = {}};
    if (!a.skipped.empty()) {
        out.state = TestCase::State::skipped;
        out.message = a.skipped;
    }
    if (!a.failed()) return out;
    out.state = TestCase::State::failed;
    out.message = fmt::format("measured {}, must be {} {}{}", shortest(a.measured), a.op, shortest(a.bound),
        a.reference_good ? "" : "; the reference is not good enough: " + a.reference_fault);
    out.text = a.text + ": " + out.message;
    return out;
}

}  // namespace

std::string junit_xml(const ReportInputs& in) {
    const Provenance& p = in.provenance;
    TestReport report{.name = in.experiment.title,
        .properties = {{"version", p.version}, {"commit", p.commit}, {"experiment", p.experiment_file},
            {"hash", p.experiment_hash}, {"command", p.command}},
        .version = p.version};
    for (const AssertionResult& a : in.metrics.assertions) report.cases.push_back(case_of(a, p.experiment_file));
    return junit_text(report);
}

// ---- timing.json: what varies between equal runs (seconds, threads, instruction set, date).

namespace {

Json arm_json(const ArmTiming& a) {
    const double rate = a.seconds > 0 ? static_cast<double>(a.samples) / a.seconds * 1e-6 : 0;
    return {{"arm", a.arm}, {"n", a.n}, {"s", number(a.s)}, {"samples", a.samples}, {"seconds", number(a.seconds)},
        {"msamples_per_s", number(rate)}};
}

}  // namespace

std::string timing_json(const Timing& timing, const Provenance& provenance) {
    Json arms = Json::array(), stages = Json::array();
    for (const ArmTiming& a : timing.arms) arms.push_back(arm_json(a));
    for (const auto& [name, seconds] : timing.stages) stages.push_back({{"name", name}, {"seconds", number(seconds)}});
    const Json out = {{"format", "crescent timing 1"}, {"estimating_s", number(timing.estimating_s)},
        {"total_s", number(timing.total_s)}, {"threads", timing.threads}, {"isa", timing.isa}, {"date", timing.date},
        {"host_cpu", timing.host_cpu}, {"arms", std::move(arms)}, {"stages", std::move(stages)},
        {"provenance", provenance_json(provenance)}};
    return text(out);
}

}  // namespace crescent
