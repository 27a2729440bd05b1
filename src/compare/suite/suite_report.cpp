// The model of the page of a suite, which suite.html lays out.
#include <fmt/format.h>

#include "compare/suite/suite_outputs.h"
#include "output/format.h"
#include "output/templates.h"

namespace crescent::inline comparison {

namespace {

std::string lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

bool is_bad(ViewState state) {
    return state == ViewState::changed || state == ViewState::noisier || state == ViewState::missing;
}

bool is_good(ViewState state) { return state == ViewState::improved || state == ViewState::same; }

/// The places that differ, as frames on the map: percent of its size.
Json frames_of(const ViewResult& view) {
    Json out = Json::array();
    if (!view.means) return out;
    const auto percents = [](int part, int whole) { return fmt::format("{:.2f}", 100.0 * part / whole); };
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
        const bool tested = t.why.empty() && !view.means->identical;
        const VarianceTest* v = r < view.variances.size() ? &view.variances[r] : nullptr;
        const bool varied = v && v->why.empty() && v->baseline > 0;
        out.push_back({{"region", t.region}, {"baseline", cell_text(figures(t.b))},
            {"candidate", cell_text(figures(t.a))}, {"change", cell_text(relative_to_baseline(t.a, t.b))},
            {"p", cell_text(tested ? figures(t.joint_p, 2) : "")},
            {"smallest", cell_text(tested ? percent(t.smallest, 2) : "")},
            {"variance", cell_text(varied ? "×" + figures(v->candidate / v->baseline, 3) : "")},
            {"variance_p", cell_text(varied ? figures(v->welch.p, 2) : "")}});
    }
    return out;
}

Json view_of(const ViewResult& view) {
    const ViewPictures& p = view.pictures;
    return {{"name", view.name}, {"lower_case", lower_case(view.name)}, {"state", name_of(view.state)},
        {"is_bad", is_bad(view.state)}, {"is_good", is_good(view.state)}, {"sentence", view.sentence},
        {"width", p.width}, {"height", p.height}, {"thumbnail", base64(p.candidate.empty() ? p.baseline : p.candidate)},
        {"only", p.baseline.empty() ? "candidate" : "baseline"}, {"baseline", base64(p.baseline)},
        {"difference", base64(p.difference)}, {"baseline_renders", plural(view.baseline_renders, "render")},
        {"candidate_renders", plural(view.candidate_renders, "render")}, {"frames", frames_of(view)},
        {"full_colour", with_minus(percent(p.scale, 2))}, {"regions", regions_of(view)}, {"notes", view.notes}};
}

}  // namespace

std::string suite_html(const Suite& suite, const SuiteResult& result, const Provenance& provenance) {
    Json states = Json::array(), views = Json::array();
    for (std::size_t k = 0; k < view_state_names.size(); ++k)
        if (const std::size_t n = result.count(static_cast<ViewState>(k)))
            states.push_back({{"state", view_state_names[k]}, {"count", n}});
    for (const ViewResult* view : by_state(result)) views.push_back(view_of(*view));
    return render_page(compare_templates(), "suite.html",
        {{"title", suite.options.title}, {"version", provenance.version}, {"command", provenance.command},
            {"sentence", result.sentence}, {"states", states}, {"views", views}});
}

}  // namespace crescent::inline comparison
