// A comparison as metrics.json (docs/compare.schema.json), metrics.csv, a report of its assertions and a summary for
// the terminal.
#include "compare/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/shared_seeds.h"
#include "compare/wording.h"
#include "output/format.h"

namespace crescent {

namespace {

Json or_null(const std::optional<double>& x) { return x ? number(*x) : Json(nullptr); }

Json measured_json(const MetricValue& m) {
    Json out = {{"value", or_null(m.value)}, {"interval", nullptr}};
    if (m.interval) out["interval"] = Json::array({number(m.interval->first), number(m.interval->second)});
    if (!m.why.empty()) out["why"] = m.why;
    return out;
}

Json region_json(const RegionResult& r) {
    Json out = {{"pixels", r.pixels}};
    for (const auto& [name, value] : r.metrics) out["metrics"][name] = measured_json(value);
    out["tail"] = r.tail
        ? Json{{"k", number(r.tail->k)}, {"se", number(r.tail->se)}, {"exceedances", r.tail->exceedances}}
        : Json(nullptr);
    out["largest_share"] = number(r.largest_share);
    if (r.heavy()) out["heavy_tail"] = {{"renders_needed", or_null(r.renders_needed)}};
    if (r.stated_ratio) out["stated_variance_ratio"] = number(*r.stated_ratio);
    out["spectrum"] = {{"power", numbers(r.power)}, {"noise", to_string(r.colour)}};
    return out;
}

Json arm_json(const ArmResult& arm, const ArmStats& readings, const std::vector<PixelSet>& sets, bool referred) {
    Json out = {
        {"arm", arm.name}, {"renders", arm.renders}, {"spp", or_null(arm.spp)}, {"seconds", or_null(arm.seconds)}};
    for (const RegionResult& r : arm.regions) out["regions"][r.region] = region_json(r);
    for (std::size_t k = 0; k < readings.files.size(); ++k) {
        const RenderFile& f = readings.files[k];
        Json file = {{"file", f.path}, {"hash", f.hash}, {"layer", f.layer}, {"spp", or_null(f.spp)},
            {"seconds", or_null(f.seconds)}};
        if (!f.variance_channels.empty()) file["variance_channels"] = f.variance_channels;
        if (!f.sample_channel.empty()) file["sample_channel"] = f.sample_channel;
        for (std::size_t r = 0; r < sets.size(); ++r) {
            const RegionStats& statistics = readings.regions[k][r];
            Json& entry = file["regions"][sets[r].name] = {{"y_mean", number(statistics.y)}};
            if (referred) {
                entry["rmse"] = number(std::sqrt(statistics.mse));
                entry["relmse"] = number(statistics.relmse);
                entry["mape"] = number(statistics.mape);
                entry["fireflies"] = statistics.fireflies;
            }
        }
        out["files"].push_back(std::move(file));
    }
    return out;
}

Json box_json(const Box& box) { return {box.x0, box.y0, box.x1, box.y1}; }

Json found_json(const std::vector<Found>& places) {
    Json out = Json::array();
    for (const Found& f : places)
        out.push_back({{"box", box_json(f.box)}, {"channel", quantity_names[f.quantity]}, {"a", number(f.a)},
            {"b", number(f.b)}, {"p", number(f.p)}});
    return out;
}

void put_test(Json& entry, const MeanTest& t) {
    entry["a"] = number(t.a);
    entry["b"] = number(t.b);
    if (!t.caveat.empty()) entry["doubt"] = t.caveat;
    if (!t.why.empty()) {
        entry["why"] = t.why;
        return;
    }
    entry["p"] = number(t.welch.p);
    entry["standard_error"] = number(t.welch.se);
    entry["df"] = number(t.welch.df);
    entry["smallest"] = number(t.smallest);
    entry["paired"] = t.paired;
}

Json region_test_json(const MeanTest& t) {
    Json out = {{"differs", !t.differs_in().empty()}, {"differs_in", t.differs_in()}};
    put_test(out, t);
    if (!std::isnan(t.joint_p)) out["joint_p"] = number(t.joint_p);
    for (const MeanTest& c : t.channels) {
        Json& entry = out["channels"][c.region] = {{"differs", c.differs}};
        put_test(entry, c);
    }
    return out;
}

Json by_json(const std::vector<std::uint64_t>& counts) {
    Json out = Json::object();
    for (std::size_t q = 0; q < counts.size(); ++q) out[quantity_names[q]] = counts[q];
    return out;
}

Json failing_json(const FailingPixels& f, int width) {
    constexpr std::size_t first_most = 5;
    Json out = {{"pixels", f.pixels.size()}, {"first", Json::array()}};
    Box box;
    for (std::size_t k = 0; k < f.pixels.size(); ++k) {
        const int x = static_cast<int>(f.pixels[k]) % width, y = static_cast<int>(f.pixels[k]) / width;
        if (k < first_most) out["first"].push_back({x, y});
        if (k == 0) box = {x, y, x, y};
        box.x0 = std::min(box.x0, x);
        box.x1 = std::max(box.x1, x);
        box.y1 = std::max(box.y1, y);
    }
    if (f.pixels.empty()) return out;
    out["box"] = box_json(box);
    out["renders"] = {f.least_renders, f.most_renders};
    out["renders_of_the_other"] = {f.least_other_renders, f.most_other_renders};
    return out;
}

Json non_finite_json(const NonFinite& n, int width) {
    Json out = {{"differs", n.differs()}, {"a", failing_json(n.a, width)}, {"b", failing_json(n.b, width)},
        {"left_out", {{"both_sides", n.two_sided}, {"one_side", n.one_sided}, {"undecided", n.undecided}}},
        {"groups", Json::object()}};
    for (const FailedGroups& g : n.groups)
        out["groups"][g.region] = {{"a", g.a}, {"b", g.b}, {"p", number(g.p)}, {"differs", g.differs}};
    return out;
}

Json seeds_json(const BiasResult& b) {
    Json out = {{"all", b.all_shared}, {"level", shared_seed_level}, {"renders", Json::array()}};
    for (const SeedPair& p : b.shared)
        out["renders"].push_back({{"a", p.a}, {"b", p.b}, {"correlation", number(p.correlation)}});
    return out;
}

Json bias_json(const BiasResult& b, int width) {
    Json out = {{"a", b.a}, {"b", b.b}, {"differs", b.differs()}, {"identical", b.identical}, {"paired", b.paired},
        {"message", b.sentence}, {"method", b.dependent ? dependent_method : "Benjamini-Hochberg"},
        {"shown", quantity_names[b.shown()]}, {"regions", Json::object()}, {"shared_seeds", seeds_json(b)},
        {"non_finite", non_finite_json(b.non_finite, width)}};
    if (!b.reference_error.empty()) out["reference_error"] = b.reference_error;
    for (const MeanTest& t : b.regions) out["regions"][t.region] = region_test_json(t);
    if (b.missed_events)
        out["unless_missed"] = {{"arm", b.missed_events->arm}, {"brighter_than", number(b.missed_events->size)},
            {"times_mean", number(b.missed_events->of_mean)}, {"one_in", number(b.missed_events->one_in)}};
    if (b.single)
        out["single"] = {{"pixels", b.single->pixels}, {"different", b.single->different},
            {"rms", number(b.single->rms)}, {"largest", number(b.single->largest)},
            {"at", {b.single->place.x0, b.single->place.y0}}};
    out["tiles"] = {{"tested", b.tiles.test_count}, {"left_out", b.tiles.left_out}, {"different", b.tiles.different},
        {"most_in", by_json(b.tiles_by)}, {"first", found_json(b.tiles_found)}};
    out["pixels"] = {{"tested", b.pixels_tested}, {"different", b.pixels_different}, {"most_in", by_json(b.pixels_by)},
        {"first", found_json(b.pixels_found)}, {"p", b.pixel_p}};
    return out;
}

Json noise_json(const NoiseResult& n) {
    std::size_t quieter = 0, noisier = 0;
    for (std::size_t t = 0; t < n.log2_ratio.size(); ++t)
        if (n.distinguished[t]) ++(n.log2_ratio[t] < 0 ? quieter : noisier);
    Json out = {{"a", n.a}, {"b", n.b}, {"tiles", n.log2_ratio.size()}, {"less_noise", quieter},
        {"more_noise", noisier}, {"message", n.sentence}, {"regions", Json::object()}};
    for (const NoiseResult::Histogram& h : n.regions)
        out["regions"][h.region] = {{"told_apart", h.different}, {"not_told_apart", h.undistinguished}};
    return out;
}

Json ladder_json(const SppLadder& ladder, const CompareResult& result) {
    Json out = {{"name", ladder.name}, {"arms", Json::array()}, {"spp", Json::array()}};
    for (const std::size_t a : ladder.arms) {
        out["arms"].push_back(result.arms[a].name);
        out["spp"].push_back(number(*result.arms[a].spp));
    }
    for (const auto& [region, slope] : ladder.slopes) out["slopes"][region] = measured_json(slope);
    return out;
}

const char* word_of(CompareResult::State state) {
    return state == CompareResult::State::holds ? "holds"
        : state == CompareResult::State::fails  ? "fails"
                                                : "inconclusive";
}

}  // namespace

Json compare_result_json(
    const ComparePlan& plan, const RenderStats& stats, const CompareResult& result, const Provenance& p) {
    Json out = {{"format", "crescent comparison 2"}, {"title", plan.title}, {"width", stats.width},
        {"height", stats.height}, {"state", word_of(result.state)}, {"message", result.sentence},
        {"found", found_about_means(result)}, {"alpha", number(plan.alpha)}, {"trim", number(plan.trim)}};
    for (std::size_t a = 0; a < result.arms.size(); ++a)
        out["arms"].push_back(arm_json(result.arms[a], stats.arms[a], stats.regions, stats.reference.has_value()));
    out["reference"] = nullptr;
    if (stats.reference) {
        Json reference = {{"files", Json::array()}, {"standard_error", Json::object()}};
        for (std::size_t k = 0; k < stats.reference->files.size(); ++k) {
            const RenderFile& f = stats.reference->files[k];
            reference["files"].push_back(
                {{"file", f.path}, {"hash", f.hash}, {"layer", f.layer}, {"spp", or_null(f.spp)},
                    {"seconds", or_null(f.seconds)}, {"y_mean", number(stats.reference->regions[k].back().y)}});
        }
        for (const auto& [region, error] : result.reference_error)
            reference["standard_error"][region] = std::isnan(error) ? Json(nullptr) : number(error);
        reference["standard_error_from"] = result.reference_error_from;
        out["reference"] = std::move(reference);
    }
    out["bias"] = out["noise"] = out["assertions"] = out["rankings"] = out["ladders"] = Json::array();
    for (const Ranking& r : result.rankings)
        out["rankings"].push_back(
            {{"region", r.region}, {"by", r.measure}, {"order", r.order}, {"message", r.sentence}});
    for (const SppLadder& l : result.ladders) out["ladders"].push_back(ladder_json(l, result));
    for (const BiasResult& b : result.bias) out["bias"].push_back(bias_json(b, stats.width));
    for (const NoiseResult& n : result.noise) out["noise"].push_back(noise_json(n));
    for (const AssertionResult& a : result.assertions)
        out["assertions"].push_back({{"name", a.name}, {"pass", a.pass}, {"measured", number(a.measured)},
            {"bound", number(a.bound)}, {"op", a.op}, {"text", a.text}});
    out["bad_pixels"] = stats.bad_pixels;
    out["warnings"] = result.warnings;
    out["provenance"] = {
        {"version", p.version}, {"commit", p.commit}, {"compiler", p.compiler}, {"command", p.command}};
    return out;
}

std::string compare_csv(const CompareResult& result) {
    std::string out = "arm,renders,region,metric,value,low,high,why\r\n";
    for (const ArmResult& arm : result.arms)
        for (const RegionResult& r : arm.regions)
            for (const auto& [name, m] : r.metrics)
                out += fmt::format("{},{},{},{},{},{},{},{}\r\n", csv_field(arm.name), arm.renders, csv_field(r.region),
                    name, m.value ? shortest(*m.value) : "", m.interval ? shortest(m.interval->first) : "",
                    m.interval ? shortest(m.interval->second) : "", csv_field(m.why));
    return out;
}

TestReport compare_report(
    const ComparePlan& plan, const CompareResult& result, const std::string& file, const std::string& version) {
    TestReport report{.name = plan.title, .version = version};
    const auto add = [&](const std::string& name, bool holds, const std::string& message, unsigned line) {
        report.cases.push_back(
            {plan.file, name, holds ? TestCase::State::passed : TestCase::State::failed, message, "", {}});
        report.rules.push_back(name);
        if (!holds) report.annotations.push_back({name, "error", message, file, line, name});
    };
    for (std::size_t k = 0; k < result.assertions.size(); ++k) {
        const AssertionResult& a = result.assertions[k];
        const bool is_in_file = k < plan.assertions.size() && plan.assertions[k].location.file == file;
        add(a.name, a.pass,
            fmt::format("{}: measured {}, must be {} {}", a.text, shortest(a.measured), a.op, shortest(a.bound)),
            is_in_file ? plan.assertions[k].location.line : 0u);
    }
    if (plan.expect == Expectation::same)
        add("the arms are the same", result.state == CompareResult::State::holds, result.sentence, 0);
    return report;
}

std::string compare_summary(
    const ComparePlan& plan, const RenderStats& stats, const CompareResult& result, const std::string& out_dir) {
    std::string out = plan.title + "\n";
    for (const std::string& w : result.warnings) out += "warning: " + w + "\n";
    if (!result.sentence.empty()) out += result.sentence + "\n";
    else if (!result.assertions.empty())
        out += fmt::format(
            "{} assertion{}.\n", result.assertions.size(), result.assertions.size() == 1 ? " holds" : "s hold");
    for (const PixelSet& set : stats.regions) {
        out += fmt::format("\n{} ({} pixels)\n  {} {} {} {} {}\n", set.name, set.pixels.size(), left("arm", 18),
            right("renders", 8), right("RMSE", 32), right("variance", 12), right("mean Y", 12));
        for (const ArmResult& arm : result.arms) {
            const RegionResult& r = arm.region(set.name);
            const MetricValue &rmse = r.metric("rmse"), &var = r.metric("var"), &y = r.metric("y_mean");
            std::string spread = rmse.value ? figures(*rmse.value) : "-";
            if (rmse.interval)
                spread += fmt::format(" ({}..{})", figures(rmse.interval->first, 3), figures(rmse.interval->second, 3));
            else if (rmse.value && r.heavy()) spread += " (heavy tail)";
            out += fmt::format("  {} {} {} {} {}\n", left(arm.name, 18), right(std::to_string(arm.renders), 8),
                right(spread, 32), right(var.value ? figures(*var.value) : "-", 12),
                right(y.value ? figures(*y.value) : "-", 12));
        }
    }
    out += "\n";
    for (const std::string& sentence : found_about_means(result, false)) out += sentence + "\n";
    if (!result.rankings.empty()) out += "\n";
    for (const Ranking& r : result.rankings) out += r.sentence + "\n";
    return out + "\n" + out_dir + "/report.html has all results.\n";
}

}  // namespace crescent
