// SVG as text; the cells of a map are painted by the page's own script from the numbers that stand beside it.
#include "judgements/pictures.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "simd/scalar.h"
#include "stats/bins.h"

namespace crescent::inline judgements {

namespace {

// A map is 260 x 200 px (`canvas` in the page's style), with room for its labels to the left and below.
constexpr double map_width = 260, map_height = 200;

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
        const double x = 40 + map_width * i / 4;
        out += fmt::format("<text x={:.1f} y=222 text-anchor=middle>{}</text><path d='M{:.1f} 205v4'/>", x, 90 * i, x);
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
        "<p>The density that the draws imply, by bin, {}: degrees from the axis downwards, one row a ring whatever it "
        "spans; degrees about it to the right. Full scale is {:.4g} 1/sr. There is no pdf(w) to hold it against.</p>"
        "<div class='row wide'><figure class=map><canvas width={} height={}></canvas><svg width=320 "
        "height=230>{}</svg><figcaption>implied density</figcaption></figure></div>"
        "<script>paint({},{:.6g},[{:.4g}])</script>",
        m.coordinates, top, m.sectors, m.rings, map_axes(m), m.sectors, top, fmt::join(m.observed, ","));
}

}  // namespace

std::string map_figures(const BinMap& m) {
    if (m.expected.empty()) return implied_figure(m);
    const double top = std::max(*std::max_element(m.observed.begin(), m.observed.end()),
        *std::max_element(m.expected.begin(), m.expected.end()));
    const std::size_t worst = worst_bin(m.observed, m.expected);
    std::string out = fmt::format(
        "<p>Draws by bin, {}: degrees from the axis downwards, one row a ring whatever it spans; degrees about it to "
        "the right. Full scale "
        "is {:.0f} draws. Difference: (observed - expected) / sqrt(expected), red more, blue fewer, full at 4. Framed: "
        "the bin that is "
        "off most, {:.0f} seen, {:.1f} due.</p><div class='row wide'>",
        m.coordinates, top, m.observed[worst], m.expected[worst]);
    for (const char* title : {"observed", "expected", "standardised difference"})
        out += fmt::format(
            "<figure class=map><canvas width={} height={}></canvas><svg width=320 "
            "height=230>{}{}</svg><figcaption>{}</figcaption></figure>",
            m.sectors, m.rings, map_axes(m), frame_of(m, worst), title);
    return out +
        fmt::format("</div><script>paint({},{:.0f},[{:.0f}],[{:.1f}])</script>", m.sectors, top,
            fmt::join(m.observed, ","), fmt::join(m.expected, ","));
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
        "</svg><figcaption>Plane of incidence, degrees of w_i from n: p (blue) over f L cos (grey), each to its own "
        "largest value</figcaption></figure>";
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
        fmt::format(
            "</table><p>In the JSON these are <code>implied_rings</code>; every bin stands in "
            "<code>implied_bins</code>{}.</p>",
            v.evidence.contains("implied_density")
                ? ", and the density by 1/|Jacobian|, direction by direction, in <code>implied_density</code>"
                : "");
}

}  // namespace crescent::inline judgements
