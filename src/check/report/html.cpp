// The HTML page of a result: the findings in sentences, tables and pictures.
#include "check/report/html.h"
#include "check/report/print.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/text.h"
#include "check/report/summary.h"
#include "math/functions.h"
#include "math/simd/scalar.h"
#include "output/charts.h"
#include "output/html.h"

namespace crescent::inline results {

namespace {

/// Counts of X by size, both logarithmic, with the fitted tail if there is one.
std::string histogram(const WeightHistogram& w) {
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
    if (w.exceedances > 0 &&
        w.sigma > 0) {  // expected by the fitted generalised Pareto distribution above its threshold
        const auto survival = [&](double v) {
            return v <= w.threshold     ? 1.0
                : std::fabs(w.k) < 1e-6 ? math::exp(-(v - w.threshold) / w.sigma)
                                        : math::pow(std::max(1 + w.k * (v - w.threshold) / w.sigma, 0.0), -1 / w.k);
        };
        std::vector<Point> tail;
        for (std::size_t i = 0; i < w.counts.size(); ++i) {
            const double low = math::pow(10.0, w.log10_edges[i]), high = math::pow(10.0, w.log10_edges[i + 1]);
            if (low < w.threshold) continue;
            const double expected = w.exceedances * (survival(low) - survival(high));
            if (expected >= 0.5) tail.push_back({(w.log10_edges[i] + w.log10_edges[i + 1]) / 2, expected});
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

/// The parts of the style sheet that only this page uses.
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

std::string names_of(const CheckResult& j) {
    std::vector<std::string> names;
    for (const Verdict& v : j.verdicts)
        if (std::find(names.begin(), names.end(), v.arm) == names.end()) names.push_back(v.arm);
    return names.size() == 1 ? names[0] : fmt::format("{} samplers", names.size());
}

std::string expected_html(const Verdict& v) {
    return fmt::format(" <em>{}: {}.</em>", v.waived ? "Waived" : "As expected of this arm", escape(v.why_expected));
}

/// One line for each finding, then every case with its verdicts.
std::string overview(const CheckResult& j) {
    std::string out;
    for (const Finding& f : findings_of(j))
        out += fmt::format("<li><b class={}>{}</b> {}{}", word(f.state), escape(f.arm), escape(describe(f)),
            f.expected ? expected_html(*f.worst) : "");
    for (const std::string& line : j.unmet) out += "<li class=wrong>" + escape(line);
    if (const std::string left = skipped_text(j); !left.empty()) out += "<li class=inconclusive>" + escape(left);
    out = out.empty() ? "<p>Nothing is wrong, nothing was left open.</p>" : "<ul>" + out + "</ul>";
    std::vector<std::string_view> names;
    for (const Verdict& v : j.verdicts)
        if (std::find(names.begin(), names.end(), v.name) == names.end()) names.push_back(v.name);
    const bool one_arm = std::ranges::all_of(j.verdicts, [&](const Verdict& v) { return v.arm == j.verdicts[0].arm; });
    out += "<div class=wide><table class=matrix><tr><th>case";
    for (std::string_view name : names) out += fmt::format("<th>{}", name);
    for (std::size_t i = 0; i < j.verdicts.size(); ++i) {
        const Verdict& v = j.verdicts[i];
        if (i == 0 || v.check_case != j.verdicts[i - 1].check_case || v.arm != j.verdicts[i - 1].arm)
            out += fmt::format("<tr><th>{}{}", one_arm ? "" : escape(v.arm) + " ", escape(v.check_case));
        out += fmt::format("<td class={}>{}", word(v.state), word(v.state));
    }
    return out + "</table></div>";
}

/// Every case with its verdicts, maps, implied density and weights.
std::string cases_html(const CheckResult& j) {
    std::string out;
    std::size_t map = 0, weight = 0;
    for (std::size_t i = 0; i < j.verdicts.size();) {
        const std::string arm = j.verdicts[i].arm, check_case = j.verdicts[i].check_case;
        std::string rows, implied;
        bool open = false;
        for (; i < j.verdicts.size() && j.verdicts[i].arm == arm && j.verdicts[i].check_case == check_case; ++i) {
            const Verdict& v = j.verdicts[i];
            open = open || v.state == State::wrong || (v.state == State::inconclusive && !v.expected);
            rows += fmt::format("<tr><td>{}<td class={}>{}<td>{}{}", v.name, word(v.state), word(v.state),
                escape(describe(v)), v.why_expected.empty() ? "" : expected_html(v));
            implied += implied_html(v);
        }
        open = open || (out.empty() && !implied.empty());  // only the first table of an implied density is open
        out += fmt::format("<details{}><summary><b>{}</b> {}</summary><table>{}</table>", open ? " open" : "",
            escape(arm), escape(check_case), rows);
        while (map < j.maps.size() && j.maps[map].arm == arm && j.maps[map].check_case == check_case)
            out += map_figures(j.maps[map++]);
        out += implied + "<div class=row>";
        while (
            weight < j.weights.size() && j.weights[weight].arm == arm && j.weights[weight].check_case == check_case) {
            out += histogram(j.weights[weight]) + rose_figure(j.weights[weight]);
            ++weight;
        }
        out += "</div></details>";
    }
    return out;
}

}  // namespace

std::string verdict_html(const CheckResult& j, const ResultSource& source) {
    PageFrame frame;
    frame.title_text = fmt::format("{}: {}", names_of(j), word(j.state));
    frame.kicker_text = "samplers checked by themselves";
    frame.version_text = source.version;
    frame.head_html = head;
    frame.lead_html = fmt::format("<p class=\"verdict {0}\">{0}</p>\n", word(j.state)) + overview(j) +
        fmt::format(
            "<p>{} statistical tests share a family-wise error of {:g}; {} failed once, {} again on a fresh "
            "seed{}.</p>\n",
            j.tests, j.alpha, j.screened, j.confirmed,
            j.questions > 0 ? fmt::format("; {} questions were answered", j.questions) : "") +
        "<p>" + escape(unseen_text(j)) + " " + escape(nothing_drawn_text(j)) + "</p>\n";
    if (!source.version.empty())
        frame.footer_html = fmt::format("crescent {}, commit {}: <code>{}</code>", escape(source.version),
            escape(source.commit), escape(source.command));
    return page_html(frame, {{"cases", "Case by case", cases_html(j)}});
}

// ---- SVG as text; the script of the page paints the cells of a map from the numbers next to it.

namespace {

// A map is 260 x 200 px (`canvas` in the style of the page), with room for labels on the left and below.
constexpr double map_width = 260, map_height = 200;
constexpr const char* axes_text = "theta downwards, phi to the right";
constexpr const char* shades = "by shade 0 to";

double degrees_of(double a) { return 2 * math::asin(std::sqrt(std::clamp(a / 2, 0.0, 1.0))) * 180 / pi; }

/// "31", or "0.02" if rings are narrow.
std::string degrees(double v) { return v >= 1 || v == 0 ? fmt::format("{:.0f}", v) : fmt::format("{:.2g}", v); }

/// All rings have the same height, independent of their angle, so their edges are labelled.
std::string map_axes(const BinHistogram& m) {
    std::string out;
    for (int i = 0; i <= 4; ++i) {
        const std::size_t edge = static_cast<std::size_t>(std::lround(0.25 * i * m.rings));
        const double y = map_height * static_cast<double>(edge) / m.rings;
        if (edge < m.edges.size())
            out += fmt::format("<text x=34 y={:.1f} text-anchor=end>{}</text><path d='M36 {:.1f}h4'/>", y + 9,
                degrees(degrees_of(m.edges[edge])), y + 5);
        const std::size_t sector = static_cast<std::size_t>(std::lround(0.25 * i * m.sectors));
        const double x = 40 + map_width * static_cast<double>(sector) / m.sectors;
        const double turn = sector < m.sector_edges.size() ? m.sector_edges[sector] : 90 * i;
        out += fmt::format(
            "<text x={:.1f} y=222 text-anchor=middle>{}</text><path d='M{:.1f} 205v4'/>", x, degrees(turn), x);
    }
    return out;
}

std::string frame_of(const BinHistogram& m, std::size_t bin) {
    const double w = map_width / m.sectors, h = map_height / m.rings;
    const double x = 40 + w * static_cast<double>(bin % static_cast<std::size_t>(m.sectors));
    const double y = 5 + h * static_cast<double>(bin / static_cast<std::size_t>(m.sectors));
    return fmt::format(
        "<rect class=worst x={:.1f} y={:.1f} width={:.1f} height={:.1f} />", x - 1.5, y - 1.5, w + 3, h + 3);
}

std::string curve(const std::vector<double>& v, std::string_view name) {
    const double top = std::max(*std::max_element(v.begin(), v.end()), 1e-300);
    std::string out = fmt::format("<polyline class={} points='", name);
    for (std::size_t i = 0; i < v.size(); ++i) {
        const double angle = (static_cast<double>(i) - 89) * pi / 180, r = 170 * v[i] / top;
        out += fmt::format("{:.1f},{:.1f} ", 210 + r * math::sin(angle), 195 - r * math::cos(angle));
    }
    return out + "'/>";
}

/// A map of densities, 1/sr.
std::string implied_figure(const BinHistogram& m) {
    const double top = std::max(m.full_scale, 1e-300);
    return fmt::format(
        "<p>Density of the draws by bin, {}. There is no pdf(w) to compare it with.</p>"
        "<div class='row wide'><figure class=map><canvas width={} height={}></canvas><svg width=320 "
        "height=230>{}</svg><figcaption>Density of the draws, {} {:.4g} 1/sr. Degrees: {}.</figcaption></figure></div>"
        "<script>paint({},{:.6g},[{:.4g}])</script>",
        m.coordinates, m.sectors, m.rings, map_axes(m), shades, top, axes_text, m.sectors, top,
        fmt::join(m.observed, ","));
}

double deviation_of(const BinHistogram& m, std::size_t bin) {
    const double sd = m.sd.empty() ? std::sqrt(std::max(m.expected[bin], 1.0)) : std::max(m.sd[bin], 1.0);
    return (m.observed[bin] - m.expected[bin]) / sd;
}

std::size_t furthest_bin(const BinHistogram& m) {
    std::size_t worst = 0;
    for (std::size_t i = 1; i < m.observed.size(); ++i)
        if (std::fabs(deviation_of(m, i)) > std::fabs(deviation_of(m, worst))) worst = i;
    return worst;
}

}  // namespace

std::string map_figures(const BinHistogram& m) {
    if (m.expected.empty()) return implied_figure(m);
    const double top = std::max(*std::max_element(m.observed.begin(), m.observed.end()),
        *std::max_element(m.expected.begin(), m.expected.end()));
    const std::size_t worst = furthest_bin(m);
    std::vector<double> deviations;
    for (std::size_t i = 0; i < m.observed.size(); ++i) deviations.push_back(deviation_of(m, i));
    std::string out = fmt::format(
        "<p>Draws by bin, {}; bins are finer where most draws are. The framed bin is furthest off: {:.0f} drawn, "
        "{:.1f} "
        "expected, {:+.1f} standard deviations; the furthest of {} bins of a right sampler is off by about 3.</p>"
        "<div class='row wide'>",
        m.coordinates, m.observed[worst], m.expected[worst], deviations[worst], m.observed.size());
    const std::string captions[] = {fmt::format("Observed: draws, {} {:.0f}. Degrees: {}.", shades, top, axes_text),
        fmt::format("Expected: what p gives, {} {:.0f}. Degrees: {}.", shades, top, axes_text),
        fmt::format(
            "Observed less expected in standard deviations: red more, blue fewer, full colour at 4. Degrees: {}.",
            axes_text)};
    for (const std::string& caption : captions)
        out += fmt::format(
            "<figure class=map><canvas width={} height={}></canvas><svg width=320 "
            "height=230>{}{}</svg><figcaption>{}</figcaption></figure>",
            m.sectors, m.rings, map_axes(m), frame_of(m, worst), caption);
    return out +
        fmt::format("</div><script>paint({},{:.0f},[{:.0f}],[{:.1f}],[{:.2f}])</script>", m.sectors, std::max(top, 1.0),
            fmt::join(m.observed, ","), fmt::join(m.expected, ","), fmt::join(deviations, ","));
}

std::string rose_figure(const WeightHistogram& w) {
    if (w.rose_p.empty()) return "";
    std::string out = "<figure class=rose><svg viewBox='0 0 420 230' width=380 height=208><path d='M20 195h380'/>";
    for (int angle = -90; angle <= 90; angle += 30) {
        const double s = math::sin(angle * pi / 180), c = math::cos(angle * pi / 180);
        out += fmt::format(
            "<path class=faint d='M210 195L{:.1f} {:.1f}'/><text x={:.1f} y={:.1f} text-anchor=middle>{}</text>",
            210 + 172 * s, 195 - 172 * c, 210 + 186 * s, (angle == 90 || angle == -90 ? 212 : 199 - 184 * c), angle);
    }
    out += curve(w.rose_f, "rose-f") + curve(w.rose_p, "rose-p");
    return out +
        "</svg><figcaption>p(w_i) (blue) and f L cos (grey) in the plane of incidence, by degrees of w_i from n; each "
        "curve is scaled to its own largest value</figcaption></figure>";
}

std::string implied_html(const Verdict& v) {
    const auto rings = v.evidence.find("implied_rings");
    if (rings == v.evidence.end()) return "";
    std::string out =
        "<table class=matrix><tr><th>degrees from n<th>implied density, mean over the ring, 1/sr<th>standard error";
    for (const auto& row : rings->at("rows"))
        out += fmt::format("<tr><td>{:.0f} to {:.0f}<td>{:.4g}<td>{:.2g}", row[0].get<double>(), row[1].get<double>(),
            row[2].get<double>(), row[3].get<double>());
    return out +
        "</table><p>In the JSON these are <code>implied_rings</code>; cells of about equal numbers of draws are "
        "<code>implied_bins</code>.</p>";
}

}  // namespace crescent::inline results
