// The page of a judgement: what was found, in sentences, tables and pictures.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/text.h"
#include "judgements/pictures.h"
#include "judgements/print.h"
#include "judgements/summary.h"
#include "judgements/told_last.h"
#include "math/functions.h"
#include "pages/charts.h"
#include "pages/page.h"

namespace crescent::inline judgements {

namespace {

/// Counts of X over its size, both logarithmic, with the fitted tail where there is one.
std::string histogram(const WeightPicture& w) {
    if (w.counts.empty()) return "";
    std::vector<double> seen;
    std::ranges::copy_if(w.counts, std::back_inserter(seen), [](double c) { return c > 0; });
    seen.push_back(0.5);
    Axis x = linear_axis("log10 of X = f L cos / p", {w.log10_edges.front(), w.log10_edges.back()});
    x.low = w.log10_edges.front(), x.high = w.log10_edges.back();
    bool line = false;
    Chart chart(420, 220, x, log_axis("draws", seen), "Histogram of the samples X");
    for (std::size_t i = 0; i < w.counts.size(); ++i)
        if (w.counts[i] > 0)
            chart.band({w.log10_edges[i], w.log10_edges[i + 1]}, {0.5, 0.5}, {w.counts[i], w.counts[i]}, "c1");
    if (w.exceedances > 0 && w.sigma > 0) {  // what the fitted generalised Pareto law expects above its threshold
        const auto survival = [&](double v) {
            return v <= w.threshold     ? 1.0
                : std::fabs(w.k) < 1e-6 ? math::exp(-(v - w.threshold) / w.sigma)
                                        : math::pow(std::max(1 + w.k * (v - w.threshold) / w.sigma, 0.0), -1 / w.k);
        };
        std::vector<Point> tail;
        for (std::size_t i = 0; i < w.counts.size(); ++i) {
            const double low = math::pow(10.0, w.log10_edges[i]), high = math::pow(10.0, w.log10_edges[i + 1]);
            if (low < w.threshold) continue;
            const double due = w.exceedances * (survival(low) - survival(high));
            if (due >= 0.5) tail.push_back({(w.log10_edges[i] + w.log10_edges[i + 1]) / 2, due});
        }
        if (tail.size() > 1) chart.line(tail, "c2"), line = true;
    }
    const std::string fitted = w.exceedances > 0
        ? fmt::format("{} Pareto tail fitted to the {:.0f} largest has k = {:.3f}{}", line ? "the" : "a", w.exceedances,
              w.k, line ? " (line)" : "")
        : std::string("the largest weights are alike, so that there is no tail to fit");
    return fmt::format(
        "<figure class=narrow>{}<figcaption>Histogram of the weights X = f L cos / p, both axes logarithmic; {}; "
        "{:.0f} draws of weight 0 are left out.</figcaption></figure>",
        chart.str(), fitted, w.zeros);
}

/// What this page needs beside the style sheet of all.
constexpr const char* head =
    "<style>.right{color:var(--good)}.inconclusive{color:var(--accent)}.wrong,.error{color:var(--bad);font-weight:600}"
    ".skipped{color:var(--soft)}.row{display:flex;flex-wrap:wrap;gap:.5em .1em}.row figure{margin:0;width:auto}"
    ".matrix{width:auto;margin:1em 0}.matrix td,.matrix th{padding:.1em .5em}.matrix th:first-child{white-space:nowrap}"
    "details{margin-bottom:.6em}"
    "summary{cursor:pointer}canvas{width:260px;height:200px;image-rendering:pixelated;outline:1px solid var(--line)}"
    ".row figure.map{position:relative;width:318px;padding-right:1em}.map "
    "canvas{position:absolute;left:40px;top:5px}.map "
    "svg{position:relative;display:block}"
    ".map text,.rose text{font-size:11px;fill:var(--soft)}.map path,.rose path{stroke:var(--soft);fill:none}.rose "
    ".faint{stroke:var(--line)}"
    ".rose "
    "polyline{fill:none;stroke-width:2}.rose-f{stroke:var(--soft)}.rose-p{stroke:var(--c1)}.worst{fill:none;stroke:#"
    "0a0;stroke-width:2}"
    ".wide{overflow-x:auto}details p{margin-top:1em}</style><script>"
    "function paint(w,top,seen,due,off){const "
    "c=document.currentScript.previousElementSibling.querySelectorAll('canvas');const "
    "night=matchMedia('(prefers-color-scheme:dark)').matches;"
    "const grey=v=>{const m=Math.min(v/top,1),g=night?25+225*m:255-225*m;return[g,g,g]};"
    "const tint=v=>{const "
    "d=v/4,a=Math.min(Math.abs(d),1),f=night?25:255*(1-a),g=25+230*a;if(night)return "
    "d<0?[f,g/2,g]:[g,f,g/3];return d<0?[f,f,255]:[255,f,f]};"
    "const draw=(k,colour)=>{const "
    "x=c[k].getContext('2d'),p=x.createImageData(w,seen.length/"
    "w);seen.forEach((o,i)=>{p.data.set([...colour(i),255],4*i)});x.putImageData(p,0,0)};"
    "draw(0,i=>grey(seen[i]));if(due){draw(1,i=>grey(due[i]));draw(2,i=>tint(off[i]))}}"
    "addEventListener('beforeprint',()=>document.querySelectorAll('details').forEach(d=>d.open=true))</script>";

std::string names_of(const Judgement& j) {
    std::vector<std::string> names;
    for (const Verdict& v : j.verdicts)
        if (std::find(names.begin(), names.end(), v.arm) == names.end()) names.push_back(v.arm);
    return names.size() == 1 ? names[0] : fmt::format("{} samplers", names.size());
}

std::string expected_html(const Verdict& v) {
    return fmt::format(" <em>{}: {}.</em>", v.waived ? "Waived" : "As expected of this arm", escape(v.why_expected));
}

/// One line a finding, then every case with its verdicts.
std::string overview(const Judgement& j) {
    std::string out;
    for (const Finding& f : findings_of(j))
        out += fmt::format("<li><b class={}>{}</b> {}{}", word(f.state), escape(f.arm), escape(told(f)),
            f.expected ? expected_html(*f.worst) : "");
    for (const std::string& line : j.unmet) out += "<li class=wrong>" + escape(line);
    if (const std::string left = left_out_told(j); !left.empty()) out += "<li class=inconclusive>" + escape(left);
    out = out.empty() ? "<p>Nothing is wrong, nothing was left open.</p>" : "<ul>" + out + "</ul>";
    std::vector<std::string_view> names;
    for (const Verdict& v : j.verdicts)
        if (std::find(names.begin(), names.end(), v.name) == names.end()) names.push_back(v.name);
    const bool one_arm = std::ranges::all_of(j.verdicts, [&](const Verdict& v) { return v.arm == j.verdicts[0].arm; });
    out += "<div class=wide><table class=matrix><tr><th>case";
    for (std::string_view name : names) out += fmt::format("<th>{}", name);
    for (std::size_t i = 0; i < j.verdicts.size(); ++i) {
        const Verdict& v = j.verdicts[i];
        if (i == 0 || v.trial != j.verdicts[i - 1].trial || v.arm != j.verdicts[i - 1].arm)
            out += fmt::format("<tr><th>{}{}", one_arm ? "" : escape(v.arm) + " ", escape(v.trial));
        out += fmt::format("<td class={}>{}", word(v.state), word(v.state));
    }
    return out + "</table></div>";
}

/// Every case with its verdicts, its maps, what its draws imply and its weights.
std::string cases_html(const Judgement& j) {
    std::string out;
    std::size_t map = 0, weight = 0;
    for (std::size_t i = 0; i < j.verdicts.size();) {
        const std::string arm = j.verdicts[i].arm, trial = j.verdicts[i].trial;
        std::string rows, implied;
        bool open = false;
        for (; i < j.verdicts.size() && j.verdicts[i].arm == arm && j.verdicts[i].trial == trial; ++i) {
            const Verdict& v = j.verdicts[i];
            open = open || v.state == State::wrong || (v.state == State::inconclusive && !v.expected);
            rows += fmt::format("<tr><td>{}<td class={}>{}<td>{}{}", v.name, word(v.state), word(v.state),
                escape(told(v)), v.why_expected.empty() ? "" : expected_html(v));
            implied += implied_html(v);
        }
        open = open || (out.empty() && !implied.empty());  // what it is asked for, once
        out += fmt::format("<details{}><summary><b>{}</b> {}</summary><table>{}</table>", open ? " open" : "",
            escape(arm), escape(trial), rows);
        while (map < j.maps.size() && j.maps[map].arm == arm && j.maps[map].trial == trial)
            out += map_figures(j.maps[map++]);
        out += implied + "<div class=row>";
        while (weight < j.weights.size() && j.weights[weight].arm == arm && j.weights[weight].trial == trial) {
            out += histogram(j.weights[weight]) + rose_figure(j.weights[weight]);
            ++weight;
        }
        out += "</div></details>";
    }
    return out;
}

}  // namespace

std::string verdict_html(const Judgement& j, const JudgementSource& source) {
    PageFrame frame;
    frame.title_text = fmt::format("{}: {}", names_of(j), word(j.state));
    frame.kicker_text = "samplers judged by themselves";
    frame.version_text = source.version;
    frame.head_html = head;
    frame.lead_html = fmt::format("<p class=\"verdict {0}\">{0}</p>\n", word(j.state)) + overview(j) +
        fmt::format(
            "<p>{} statistical tests share a family-wise error of {:g}; {} failed once, {} again on a fresh "
            "seed{}.</p>\n",
            j.tests, j.alpha, j.screened, j.confirmed,
            j.questions > 0 ? fmt::format("; {} questions were answered", j.questions) : "") +
        "<p>" + escape(unseen_told(j)) + " " + escape(nothing_drawn_told(j)) + " " + escape(not_looked_at_told(j)) +
        "</p>\n";
    if (!source.version.empty())
        frame.footer_html = fmt::format("crescent {}, commit {}: <code>{}</code>", escape(source.version),
            escape(source.commit), escape(source.command));
    return page_html(frame, {{"cases", "Case by case", cases_html(j)}});
}

}  // namespace crescent::inline judgements
