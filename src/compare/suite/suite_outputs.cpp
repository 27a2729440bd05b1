// A suite's result as JSON, JUnit, Markdown and a summary for the terminal.
#include "compare/suite/suite_outputs.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/text.h"
#include "compare/renders.h"
#include "compare/suite/decide.h"
#include "compare/suite/suite.h"
#include "output/format.h"
#include "output/templates.h"

namespace crescent {

namespace {

Json p_json(double p) { return std::isnan(p) ? Json(nullptr) : crescent::number(p); }

Json mean_json(const MeanTest& t) {
    Json out = {
        {"baseline", crescent::number(t.b)}, {"candidate", crescent::number(t.a)}, {"differs_in", t.differs_in()}};
    if (!t.why.empty()) out["why"] = t.why;
    else {
        out["p"] = p_json(t.joint_p);
        out["standard_error"] = crescent::number(t.welch.se);
        out["smallest"] = crescent::number(t.smallest);
        out["paired"] = t.paired;
    }
    if (!t.caveat.empty()) out["doubt"] = t.caveat;
    return out;
}

Json variance_json(const VarianceTest& t) {
    Json out = {{"baseline", crescent::number(t.baseline)}, {"candidate", crescent::number(t.candidate)},
        {"differs", t.different}};
    if (!t.why.empty()) out["why"] = t.why;
    else out["p"] = crescent::number(t.welch.p);
    return out;
}

Json places_json(const std::vector<Found>& places) {
    Json out = Json::array();
    for (const Found& f : places)
        out.push_back({{"box", {f.box.x0, f.box.y0, f.box.x1, f.box.y1}}, {"channel", quantity_names[f.quantity]},
            {"baseline", crescent::number(f.b)}, {"candidate", crescent::number(f.a)}, {"p", crescent::number(f.p)}});
    return out;
}

Json outliers_json(const ViewOutliers& o) {
    Json first = Json::array();
    for (const ViewOutliers::Place& outlier : o.first)
        first.push_back(
            {{"file", outlier.file}, {"pixel", {outlier.x, outlier.y}}, {"channel", quantity_names[outlier.quantity]},
                {"value", crescent::number(outlier.value)}, {"others", crescent::number(outlier.others)}});
    return {{"baseline", o.baseline}, {"candidate", o.candidate}, {"p", p_json(o.p)}, {"left_out", o.set_apart},
        {"first", first}};
}

Json outlier_render_json(const ViewOutlierRender& r) {
    if (r.file.empty()) return nullptr;
    return {{"file", r.file}, {"deviation", crescent::number(r.deviation)}, {"ratio", crescent::number(r.ratio)},
        {"outlier_pixels", r.pixels}, {"p", p_json(r.p)}};
}

Json view_json(const ViewResult& view) {
    Json out = {{"view", view.name}, {"state", name_of(view.state)}, {"headline", view.headline},
        {"sentence", view.sentence}, {"width", view.width}, {"height", view.height},
        {"renders", {{"baseline", view.baseline_renders}, {"candidate", view.candidate_renders}}},
        {"smallest", crescent::number(view.smallest)}, {"deterministic", view.exact}, {"moments", view.moments},
        {"p", {{"means", p_json(view.mean_p)}, {"variances", p_json(view.variance_p)}}},
        {"level", crescent::number(view.level)},
        {"renders_needed", view.renders_needed ? Json(*view.renders_needed) : Json(nullptr)}, {"notes", view.notes},
        {"means", Json::object()}, {"variances", Json::object()}};
    for (const VarianceTest& t : view.variances) out["variances"][t.region] = variance_json(t);
    out["non_finite"] = view.non_finite;
    out["outliers"] = outliers_json(view.outliers);
    out["outlier_render"] = outlier_render_json(view.outlier_render);
    if (!view.means) return out;
    const BiasResult& means = *view.means;
    for (const MeanTest& t : means.regions) out["means"][t.region] = mean_json(t);
    out["identical"] = means.identical && view.other_channels.empty();
    out["paired"] = means.paired;
    out["tiles"] = {{"tested", means.tiles.test_count}, {"different", means.tiles.different},
        {"first", places_json(means.tiles_found)}};
    out["pixels"] = {{"tested", means.pixels_tested}, {"different", means.pixels_different},
        {"first", places_json(means.pixels_found)}};
    return out;
}

TestCase::State case_state(const ViewResult& view, bool new_baseline) {
    switch (view.state) {
        case ViewState::changed:
        case ViewState::noisier:
        case ViewState::missing: return TestCase::State::failed;
        case ViewState::unreadable:
        case ViewState::too_few: return TestCase::State::error;
        case ViewState::added: return new_baseline ? TestCase::State::skipped : TestCase::State::failed;
        default: return TestCase::State::passed;
    }
}

/// Escapes text for a cell of a Markdown table.
std::string cell(const std::string& text) {
    std::string out;
    for (const char c : printable(text)) {
        if (c == '<') out += "&lt;";
        else if (c == '@') out += "@&#8203;";  // a name of a view mentions nobody
        else if (std::string_view("|\\`*_[]").find(c) != std::string_view::npos) {
            out += '\\';
            out += c;
        } else out += c;
    }
    return out;
}

double relative_size(double candidate, double baseline) {
    if (candidate == baseline) return 0;
    return baseline == 0 ? 1 : std::fabs(candidate / baseline - 1);
}

/// The largest relative change of what differs in a view: a region, a tile, a pixel of a view without noise, or the
/// variance; infinite if values are not finite.
double size_of_change(const ViewResult& view) {
    if (!view.non_finite.empty()) return HUGE_VAL;
    double out = 0;
    for (const VarianceTest& t : view.variances)
        if (t.different) out = std::max(out, relative_size(t.candidate, t.baseline));
    if (view.exact_difference) out = std::max(out, std::min(1.0, view.exact_difference->share));
    if (!view.means) return out;
    for (const MeanTest& t : view.means->regions) {
        if (t.differs) out = std::max(out, relative_size(t.a, t.b));
        for (const MeanTest& c : t.channels)
            if (c.differs) out = std::max(out, relative_size(c.a, c.b));
    }
    for (const Found& f : view.means->tiles_found) out = std::max(out, relative_size(f.a, f.b));
    return out;
}

const char* mark_of(ViewState state) {
    switch (state) {
        case ViewState::unreadable:
        case ViewState::changed:
        case ViewState::noisier:
        case ViewState::missing: return "❌";
        case ViewState::too_few: return "⚠️";
        case ViewState::added: return "🆕";
        default: return "✅";
    }
}

}  // namespace

std::vector<const ViewResult*> by_state(const SuiteResult& result) {
    std::vector<const ViewResult*> out;
    for (const ViewResult& view : result.views) out.push_back(&view);
    std::sort(out.begin(), out.end(), [](const ViewResult* a, const ViewResult* b) {
        if (a->state != b->state) return a->state < b->state;
        const double x = size_of_change(*a), y = size_of_change(*b);
        return x != y ? x > y : a->name < b->name;
    });
    return out;
}

std::string suite_json(const Suite& suite, const SuiteResult& result, bool new_baseline, const Provenance& p) {
    Json out = {{"format", "crescent suite 1"}, {"title", suite.options.title}, {"sentence", result.sentence},
        {"exit_code", exit_code(result, new_baseline)}, {"alpha", crescent::number(suite.options.alpha)},
        {"share_of_means", crescent::number(share_of_means)}, {"views_tested", result.tested_views},
        {"counts", Json::object()}, {"views", Json::array()}};
    for (std::size_t k = 0; k < view_state_names.size(); ++k)
        out["counts"][view_state_names[k]] = result.count(static_cast<ViewState>(k));
    for (const ViewResult& view : result.views) out["views"].push_back(view_json(view));
    out["provenance"] = {
        {"version", p.version}, {"commit", p.commit}, {"compiler", p.compiler}, {"command", p.command}};
    return text(out);
}

TestReport suite_report(const Suite& suite, const SuiteResult& result, bool new_baseline, const std::string& version) {
    TestReport report{.name = suite.options.title,
        .properties = {{"alpha", shortest(suite.options.alpha)}},
        .rules = {view_state_names.begin(), view_state_names.end()},
        .version = version};
    for (const ViewResult& view : result.views)
        report.cases.push_back({suite.file.empty() ? "crescent compare" : suite.file, view.name,
            case_state(view, new_baseline), fmt::format("{}: {}", name_of(view.state), view.sentence), "", {}});
    for (const ViewResult* view : by_state(result)) {
        const TestCase::State state = case_state(*view, new_baseline);
        if (state == TestCase::State::passed) continue;
        const auto entry = std::find_if(suite.views.begin(), suite.views.end(),
            [&](const SuiteView& candidate) { return candidate.name == view->name; });
        const char* level = state == TestCase::State::failed ? "error"
            : state == TestCase::State::error                ? "warning"
                                                             : "note";
        report.annotations.push_back({name_of(view->state), level, view->name + ": " + view->headline, suite.file,
            entry == suite.views.end() ? 0 : entry->location.line, view->name});
    }
    return report;
}

TestReport failure_report(const std::string& file, const std::exception& error, const std::string& version) {
    TestReport report{.name = "crescent compare",
        .cases = {{file.empty() ? "crescent compare" : file, "input", TestCase::State::error, error.what(), "", {}}},
        .rules = {"input"},
        .version = version};
    std::vector<Diagnostic> mistakes = {{{}, error.what()}};
    if (const auto* input = dynamic_cast<const InputError*>(&error)) mistakes = input->diagnostics();
    for (const Diagnostic& mistake : mistakes) {
        const bool is_in_file = !file.empty() && mistake.location.file == file;
        const std::string message = is_in_file || mistake.location.file.empty()
            ? mistake.message
            : to_string(mistake.location) + ": " + mistake.message;
        report.annotations.push_back(
            {"input", "error", message, file, is_in_file ? mistake.location.line : 0u, "input: " + message});
    }
    return report;
}

std::string suite_markdown(const Suite& suite, const SuiteResult& result, const Provenance& provenance) {
    constexpr std::size_t limit = 60'000;
    std::string out = fmt::format("### {}\n\n{}\n", cell(suite.options.title), cell(result.sentence));
    const std::string end = fmt::format("\ncrescent {}\n", provenance.version);
    bool has_begun = false;
    std::size_t left_out = 0;
    for (const ViewResult* view : by_state(result)) {
        if (view->state == ViewState::same) continue;
        const std::string row = fmt::format("| {} {} | {} | {} |\n", mark_of(view->state), name_of(view->state),
            cell(view->name), cell(view->headline));
        constexpr std::size_t reserve = 200;  // for the lines below the table
        if (out.size() + row.size() + end.size() + reserve > limit) {
            ++left_out;
            continue;
        }
        if (!has_begun) out += "\n| state | view | what was found |\n|---|---|---|\n";
        has_begun = true;
        out += row;
    }
    if (left_out) out += fmt::format("\n{} more; the report has them.\n", plural(left_out, "view"));
    return out + end;
}

std::string suite_summary(const Suite& suite, const SuiteResult& result) {
    std::string out = suite.options.title + "\n";
    std::size_t longest = 0;
    for (const ViewResult& view : result.views) longest = std::max(longest, width(view.name));
    constexpr std::size_t widest = 40;
    longest = std::min(longest, widest);
    for (const ViewResult* view : by_state(result)) {
        out += fmt::format("{}  {}  {}\n", left(name_of(view->state), 15), left(view->name, longest), view->headline);
        if (view->sentence != view->headline) out += fmt::format("{:17}{}\n", "", view->sentence);
        for (const std::string& note : view->notes) out += fmt::format("{:17}{}\n", "", note);
    }
    return out + "\n" + result.sentence + "\n";
}

// ---- The model of the page of a suite, which suite.html lays out.

namespace {

std::string lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

bool is_bad(ViewState state) {
    return state == ViewState::unreadable || state == ViewState::changed || state == ViewState::noisier ||
        state == ViewState::missing;
}

bool is_good(ViewState state) { return state == ViewState::improved || state == ViewState::same; }

/// The places that differ, as frames on the map: percent of its size.
Json frames_of(const ViewResult& view) {
    Json out = Json::array();
    if (!view.means) return out;
    const auto percents = [](int part, int total) { return fmt::format("{:.2f}", 100.0 * part / total); };
    for (const auto* places : {&view.means->tiles_found, &view.means->pixels_found})
        for (const Found& f : *places)
            out.push_back(
                {{"left", percents(f.box.x0, view.width)}, {"top", percents(view.height - 1 - f.box.y1, view.height)},
                    {"wide", percents(f.box.width(), view.width)}, {"high", percents(f.box.height(), view.height)}});
    return out;
}

std::string relative_to_baseline(double candidate, double baseline) {
    return baseline == 0 ? "" : (candidate < baseline ? "-" : "+") + percent(std::fabs(candidate / baseline - 1), 2);
}

Json regions_of(const ViewResult& view) {
    Json out = Json::array();
    if (!view.means || view.exact) return out;
    for (std::size_t r = 0; r < view.means->regions.size(); ++r) {
        const MeanTest& t = view.means->regions[r];
        const bool is_tested = t.why.empty() && !view.means->identical;
        const VarianceTest* v = r < view.variances.size() ? &view.variances[r] : nullptr;
        const bool has_variance = v && v->why.empty() && v->baseline > 0;
        out.push_back({{"region", t.region}, {"baseline", cell_text(figures(t.b))},
            {"candidate", cell_text(figures(t.a))}, {"change", cell_text(relative_to_baseline(t.a, t.b))},
            {"p", cell_text(is_tested ? figures(t.joint_p, 2) : "")},
            {"smallest", cell_text(is_tested ? percent(t.smallest, 2) : "")},
            {"variance", cell_text(has_variance ? "×" + figures(v->candidate / v->baseline, 3) : "")},
            {"variance_p", cell_text(has_variance ? figures(v->welch.p, 2) : "")}});
    }
    return out;
}

/// The places that the map of significance shows.
std::string places_of(const BiasResult& means) {
    return fmt::format("{} of {} tiles, {} of {} pixels", means.tiles.different, means.tiles.test_count,
        means.pixels_different, means.pixels_tested);
}

Json view_of(const ViewResult& view) {
    const ViewPictures& p = view.pictures;
    return {{"name", view.name}, {"lower_case", lower_case(view.name)}, {"state", name_of(view.state)},
        {"is_bad", is_bad(view.state)}, {"is_good", is_good(view.state)}, {"headline", view.headline},
        {"details", view.sentence == view.headline ? "" : view.sentence}, {"width", p.width}, {"height", p.height},
        {"thumbnail", base64(p.candidate.empty() ? p.baseline : p.candidate)},
        {"only", p.baseline.empty() ? "candidate" : "baseline"}, {"baseline", base64(p.baseline)},
        {"difference", base64(p.difference)}, {"significance", base64(p.significance)}, {"noise", base64(p.noise)},
        {"places", p.significance.empty() ? "" : places_of(*view.means)},
        {"baseline_renders", plural(view.baseline_renders, "render")},
        {"candidate_renders", plural(view.candidate_renders, "render")}, {"frames", frames_of(view)},
        {"full_colour", with_minus(percent(p.scale, 2))}, {"regions", regions_of(view)}, {"notes", view.notes}};
}

}  // namespace

std::vector<std::pair<std::string, std::vector<unsigned char>>> suite_plates(const SuiteResult& result) {
    std::vector<std::pair<std::string, std::vector<unsigned char>>> out;
    std::size_t number = 0;
    for (const ViewResult* view : by_state(result)) {
        if (is_good(view->state)) continue;
        std::string name = view->name;  // a build server refuses some characters in the names of files
        for (char& c : name)
            if (!std::isalnum(static_cast<unsigned char>(c)) &&
                std::string_view("._-").find(c) == std::string_view::npos)
                c = '-';
        ++number;
        const ViewPictures& p = view->pictures;
        for (const auto& [kind, bytes] : {std::pair{"baseline", &p.baseline}, std::pair{"candidate", &p.candidate},
                 std::pair{"difference", &p.difference}, std::pair{"significance", &p.significance},
                 std::pair{"noise", &p.noise}})
            if (!bytes->empty()) out.emplace_back(fmt::format("plates/{}-{}-{}.png", number, name, kind), *bytes);
    }
    return out;
}

std::string suite_html(const Suite& suite, const SuiteResult& result, const Provenance& provenance) {
    Json states = Json::array(), views = Json::array();
    for (std::size_t k = 0; k < view_state_names.size(); ++k)
        if (const std::size_t n = result.count(static_cast<ViewState>(k)))
            states.push_back({{"state", view_state_names[k]}, {"count", n}});
    constexpr std::size_t shown_at_once = 3;  // of the views that fail
    for (const ViewResult* view : by_state(result)) {
        views.push_back(view_of(*view));
        views.back()["is_open"] = is_bad(view->state) && views.size() <= shown_at_once;
    }
    return render_page(compare_templates(), "suite.html",
        {{"title", suite.options.title}, {"version", provenance.version}, {"command", provenance.command},
            {"sentence", result.sentence}, {"states", states}, {"views", views}});
}

}  // namespace crescent
