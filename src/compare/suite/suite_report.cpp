// report.html of a suite: a grid of views, changed first, that can be filtered by name and state. A view opens to its
// sentence, baseline and candidate with a slider between them, the difference map and its numbers. Pictures are decoded
// when they are first shown.
#include <fmt/format.h>

#include "compare/suite/suite_outputs.h"
#include "output/format.h"
#include "output/html.h"

namespace crescent::inline comparison {

namespace {

using html::words;

constexpr const char* head = R"html(<style>
main, header, footer { max-width: 76rem; }
.filter { display: flex; flex-wrap: wrap; gap: 0.4rem 1.1rem; align-items: center; margin: 1.2rem 0; }
.filter input[type=search] { font: inherit; padding: 0.25rem 0.6rem; border: 1px solid var(--line); border-radius: 4px;
  background: var(--tint); color: inherit; min-width: 14rem; }
.filter label { white-space: nowrap; cursor: pointer; }
.views { display: grid; grid-template-columns: repeat(auto-fill, minmax(15rem, 1fr)); gap: 1rem; align-items: start; }
.views details { border: 1px solid var(--line); border-radius: 6px; overflow: hidden; background: var(--tint);
  content-visibility: auto; contain-intrinsic-size: 15rem 14rem; }
.views details[open] { grid-column: 1 / -1; }
.views summary { cursor: pointer; list-style: none; }
.views summary::-webkit-details-marker { display: none; }
.views summary:focus-visible { outline: 2px solid var(--accent); outline-offset: -2px; }
.views summary img { display: block; width: 100%; height: auto; aspect-ratio: 16 / 9; object-fit: contain; background: #000; }
.views details[open] summary img { display: none; }
.views .title { display: flex; justify-content: space-between; gap: 0.6rem; padding: 0.5rem 0.8rem; font-weight: 600; }
.views .title span:first-child { overflow-wrap: anywhere; }
.views .state { white-space: nowrap; font-size: 0.8rem; font-weight: 600; }
.views .open { padding: 0 0.8rem 0.8rem; }
.views .pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(26rem, 100%), 1fr)); gap: 1rem; }
.views figure { margin: 0; width: auto; }
.wipe { position: relative; --x: 50%; background: #000; }
.wipe img, .difference img { display: block; width: 100%; height: auto; image-rendering: pixelated; }
.wipe img + img { position: absolute; inset: 0; clip-path: inset(0 0 0 var(--x)); }
.wipe::after { content: ""; position: absolute; top: 0; bottom: 0; left: var(--x); width: 2px; background: #fff;
  box-shadow: 0 0 0 1px #000; pointer-events: none; }
.wipe input { position: absolute; inset: 0; width: 100%; height: 100%; margin: 0; opacity: 0; cursor: ew-resize; }
.wipe:has(input:focus-visible) { outline: 2px solid var(--accent); }
.sides { display: flex; justify-content: space-between; }
.difference { position: relative; }
.difference i { position: absolute; outline: 2px solid #fff; box-shadow: 0 0 0 3px #000; min-width: 4px; min-height: 4px; }
.views .table { margin: 1rem 0 0; width: auto; } .views .table table { min-width: 0; margin: 0; }
.views ul { margin: 0.6rem 0 0; font-size: 0.9rem; }
footer { margin-top: 2rem; }
[hidden] { display: none !important; }
</style>
<script>
document.addEventListener("DOMContentLoaded", () => {
  const views = [...document.querySelectorAll(".views details")];
  const load = view => view.querySelectorAll("img[data-src]").forEach(image => {
    image.src = image.dataset.src || view.querySelector("summary img").src; image.removeAttribute("data-src"); });
  views.forEach(view => view.addEventListener("toggle", () => { if (view.open) load(view); }));
  document.querySelectorAll(".wipe input").forEach(slider => slider.addEventListener("input", () =>
    slider.parentElement.style.setProperty("--x", slider.value + "%")));
  const text = document.querySelector(".filter input[type=search]");
  const boxes = [...document.querySelectorAll(".filter input[type=checkbox]")];
  const shown = document.querySelector(".filter output");
  const filter = () => {
    const states = new Set(boxes.filter(box => box.checked).map(box => box.value));
    let count = 0;
    views.forEach(view => {
      view.hidden = !(states.has(view.dataset.state) && view.dataset.name.includes(text.value.toLowerCase()));
      count += !view.hidden;
    });
    shown.textContent = count + " of " + views.length + " shown";
  };
  text.addEventListener("input", filter);
  boxes.forEach(box => box.addEventListener("change", filter));
  filter();
  const open = () => { const view = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (view && views.includes(view)) { view.open = true; load(view); view.scrollIntoView(); } };
  addEventListener("hashchange", open); open();
});
</script>
)html";

std::string source_of(const std::vector<unsigned char>& png) { return "data:image/png;base64," + base64(png); }

std::string lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

const char* class_of(ViewState state) {
    switch (state) {
        case ViewState::changed:
        case ViewState::noisier:
        case ViewState::missing: return "state bad";
        case ViewState::improved:
        case ViewState::same: return "state good";
        default: return "state";
    }
}

std::string filter_bar(const SuiteResult& result) {
    std::string out =
        "<div class=\"filter\"><input type=\"search\" placeholder=\"name of a view\" "
        "aria-label=\"Filter by name\" />";
    for (std::size_t k = 0; k < view_state_names.size(); ++k)
        if (const std::size_t n = result.count(static_cast<ViewState>(k)))
            out += fmt::format("<label><input type=\"checkbox\" checked=\"checked\" value=\"{0}\" /> {0} ({1})</label>",
                view_state_names[k], n);
    return out + "<output></output></div>\n";
}

/// The places that differ, as frames on the map.
std::string frames(const ViewResult& view) {
    std::string out;
    if (!view.means) return out;
    for (const auto* places : {&view.means->tiles_found, &view.means->pixels_found})
        for (const Found& f : *places)
            out += fmt::format("<i style=\"left:{:.2f}%;top:{:.2f}%;width:{:.2f}%;height:{:.2f}%\"></i>",
                100.0 * f.box.x0 / view.width, 100.0 * (view.height - 1 - f.box.y1) / view.height,
                100.0 * f.box.width() / view.width, 100.0 * f.box.height() / view.height);
    return out;
}

/// Returns an <img> of one picture; `png` is empty for the picture of the card.
std::string picture(const std::vector<unsigned char>& png, const ViewPictures& all, const std::string& alt) {
    return fmt::format("<img alt=\"{}\" width=\"{}\" height=\"{}\" data-src=\"{}\" />", escape(alt), all.width,
        all.height, png.empty() ? "" : source_of(png));
}

std::string pictures(const ViewResult& view) {
    const ViewPictures& p = view.pictures;
    if (p.difference.empty()) {
        const bool added = p.baseline.empty();
        return fmt::format("<div class=\"pictures\"><figure>{}<figcaption>{}</figcaption></figure></div>\n",
            picture({}, p, added ? "candidate" : "baseline"), added ? "candidate, one render" : "baseline, one render");
    }
    return fmt::format(
        "<div class=\"pictures\"><figure><div class=\"wipe\">{}{}<input type=\"range\" min=\"0\" max=\"100\" "
        "value=\"50\" aria-label=\"baseline left of this, candidate right\" /></div><figcaption "
        "class=\"sides\"><span>baseline, mean of {}</span><span>candidate, mean of {}</span></figcaption></figure>\n"
        "<figure><div class=\"difference\">{}{}</div><figcaption>Difference of the means: orange, the candidate is "
        "brighter, blue, darker; full colour at {}.</figcaption></figure></div>\n",
        picture(p.baseline, p, "baseline"), picture({}, p, "candidate"), plural(view.baseline_renders, "render"),
        plural(view.candidate_renders, "render"), picture(p.difference, p, "difference map"), frames(view),
        html::number(percent(p.scale, 2)));
}

std::string relative_to_baseline(double candidate, double baseline) {
    return baseline == 0 ? "" : (candidate < baseline ? "-" : "+") + percent(std::fabs(candidate / baseline - 1), 2);
}

std::string numbers(const ViewResult& view) {
    if (!view.means || view.exact) return "";
    html::Table table("Mean <i>Y</i>, and the variance of a pixel as a multiple of the baseline's",
        {words("region"), {"baseline", true}, {"candidate", true}, {"difference", true}, {"<i>p</i>", true},
            {"would be found", true}, {"variance", true}, {"<i>p</i>", true}});
    for (std::size_t r = 0; r < view.means->regions.size(); ++r) {
        const MeanTest& t = view.means->regions[r];
        const bool tested = t.why.empty() && !view.means->identical;
        const VarianceTest* v = r < view.variances.size() ? &view.variances[r] : nullptr;
        const bool varied = v && v->why.empty() && v->baseline > 0;
        table.row({html::heading(escape(t.region)), html::figure(figures(t.b)), html::figure(figures(t.a)),
            html::figure(relative_to_baseline(t.a, t.b)), html::figure(tested ? figures(t.joint_p, 2) : ""),
            html::figure(tested ? percent(t.smallest, 2) : ""),
            html::figure(varied ? "×" + figures(v->candidate / v->baseline, 3) : ""),
            html::figure(varied ? figures(v->welch.p, 2) : "")});
    }
    return table.str();
}

std::string card(const ViewResult& view) {
    const ViewPictures& p = view.pictures;
    const std::vector<unsigned char>& thumbnail = p.candidate.empty() ? p.baseline : p.candidate;
    std::vector<std::string> notes;
    for (const std::string& note : view.notes) notes.push_back(escape(note));
    return fmt::format(
        "<details id=\"{0}\" data-name=\"{1}\" data-state=\"{2}\"><summary><img alt=\"\" loading=\"lazy\" "
        "decoding=\"async\" width=\"{3}\" height=\"{4}\" src=\"{5}\" /><span class=\"title\"><span>{0}</span><span "
        "class=\"{6}\">{2}</span></span></summary>\n<div class=\"open\"><p>{7}</p>\n{8}{9}{10}</div></details>\n",
        escape(view.name), escape(lower_case(view.name)), name_of(view.state), p.width, p.height, source_of(thumbnail),
        class_of(view.state), escape(view.sentence), pictures(view), numbers(view),
        notes.empty() ? "" : html::list(notes));
}

}  // namespace

std::string suite_html(const Suite& suite, const SuiteResult& result, const Provenance& provenance) {
    PageFrame frame;
    frame.title_text = suite.options.title;
    frame.kicker_text = "golden images";
    frame.version_text = provenance.version;
    frame.lead_html = html::p(escape(result.sentence));
    frame.footer_html =
        fmt::format("Made by crescent {}: {}", escape(provenance.version), html::code(provenance.command));
    frame.head_html = head;
    std::string grid = filter_bar(result) + "<div class=\"views\">\n";
    for (const ViewResult* view : by_state(result)) grid += card(*view);
    return page_html(frame, {{"views", "Views", grid + "</div>\n"}});
}

}  // namespace crescent::inline comparison
