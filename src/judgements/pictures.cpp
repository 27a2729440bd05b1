// SVG as text; the cells of a map are painted by the page's own script from the numbers that stand beside it.
#include "judgements/pictures.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "simd/scalar.h"

namespace crescent::inline judgements {

namespace {

// A map is 260 x 200 px (`canvas` in the page's style), with room for its labels to the left and below.
constexpr double map_width = 260, map_height = 200;
constexpr const char* axes_text = "theta downwards, phi to the right";
constexpr const char* shades = "by shade 0 to";

double degrees_of(double a) { return 2 * math::asin(std::sqrt(std::clamp(a / 2, 0.0, 1.0))) * 180 / pi; }

/// "31", and "0.02" where rings are narrow.
std::string degrees(double v) { return v >= 1 || v == 0 ? fmt::format("{:.0f}", v) : fmt::format("{:.2g}", v); }

/// Rings are as high as each other, whatever angle they span: their edges are labelled.
std::string map_axes(const BinMap& m) {
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

std::string frame_of(const BinMap& m, std::size_t bin) {
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

/// Of densities, 1/sr.
std::string implied_figure(const BinMap& m) {
    const double top = std::max(m.full_scale, 1e-300);
    return fmt::format(
        "<p>Density of the draws by bin, {}. There is no pdf(w) to compare it with.</p>"
        "<div class='row wide'><figure class=map><canvas width={} height={}></canvas><svg width=320 "
        "height=230>{}</svg><figcaption>Density of the draws, {} {:.4g} 1/sr. Degrees: {}.</figcaption></figure></div>"
        "<script>paint({},{:.6g},[{:.4g}])</script>",
        m.coordinates, m.sectors, m.rings, map_axes(m), shades, top, axes_text, m.sectors, top,
        fmt::join(m.observed, ","));
}

double deviation_of(const BinMap& m, std::size_t bin) {
    const double sd = m.sd.empty() ? std::sqrt(std::max(m.expected[bin], 1.0)) : std::max(m.sd[bin], 1.0);
    return (m.observed[bin] - m.expected[bin]) / sd;
}

std::size_t furthest_bin(const BinMap& m) {
    std::size_t worst = 0;
    for (std::size_t i = 1; i < m.observed.size(); ++i)
        if (std::fabs(deviation_of(m, i)) > std::fabs(deviation_of(m, worst))) worst = i;
    return worst;
}

}  // namespace

std::string map_figures(const BinMap& m) {
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

std::string rose_figure(const WeightPicture& w) {
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

}  // namespace crescent::inline judgements
