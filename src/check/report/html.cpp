// The model of the HTML page of a result: check.html and the templates that it includes lay it out.
#include "check/report/html.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/report/summary.h"
#include "math/functions.h"
#include "math/simd/scalar.h"
#include "output/charts.h"
#include "output/templates.h"

namespace crescent {

namespace {

/// Counts of X by size, both logarithmic, with the fitted tail if there is one.
Json histogram(const WeightHistogram& w) {
    if (w.counts.empty()) return false;
    std::vector<double> positive_counts;
    std::ranges::copy_if(w.counts, std::back_inserter(positive_counts), [](double c) { return c > 0; });
    positive_counts.push_back(0.5);
    Axis x = linear_axis("log10 of X = f L cos / p", {w.log10_edges.front(), w.log10_edges.back()});
    x.low = w.log10_edges.front();
    x.high = w.log10_edges.back();
    bool has_line = false;
    Chart chart(420, 220, x, log_axis("draws", positive_counts), "Histogram of the samples X");
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
        if (tail.size() > 1) {
            chart.line(tail, "c2");
            has_line = true;
        }
    }
    Json tail = false;
    if (w.exceedances > 0)
        tail = {{"has_line", has_line}, {"exceedances", fmt::format("{:.0f}", w.exceedances)},
            {"k", fmt::format("{:.3f}", w.k)}};
    return {{"chart", chart.str()}, {"tail", tail}, {"zeros", fmt::format("{:.0f}", w.zeros)}};
}

// A map is 260 x 200 px (`canvas` in the style of the page), with room for labels on the left and below.
constexpr double map_width = 260, map_height = 200, map_left = 40, map_top = 5;

std::string pixels(double v) { return fmt::format("{:.1f}", v); }

double degrees_of(double a) { return 2 * math::asin(std::sqrt(std::clamp(a / 2, 0.0, 1.0))) * 180 / pi; }

/// "31", or "0.02" if rings are narrow.
std::string degrees(double v) { return v >= 1 || v == 0 ? fmt::format("{:.0f}", v) : fmt::format("{:.2g}", v); }

/// All rings have the same height, independent of their angle, so their edges are labelled.
Json ring_ticks(const BinHistogram& m) {
    Json out = Json::array();
    for (int i = 0; i <= 4; ++i) {
        const std::size_t edge = static_cast<std::size_t>(std::lround(0.25 * i * m.rings));
        if (edge >= m.edges.size()) continue;
        const double y = map_top + map_height * static_cast<double>(edge) / m.rings;
        const std::string& label = m.ring_labels[static_cast<std::size_t>(i)];
        out.push_back({{"y", pixels(y)}, {"text_y", pixels(y + 4)},
            {"degrees", label.empty() ? degrees(degrees_of(m.edges[edge])) : label}});
    }
    return out;
}

Json sector_ticks(const BinHistogram& m) {
    Json out = Json::array();
    for (int i = 0; i <= 4; ++i) {
        const std::size_t sector = static_cast<std::size_t>(std::lround(0.25 * i * m.sectors));
        const double x = map_left + map_width * static_cast<double>(sector) / m.sectors;
        const double turn = sector < m.sector_edges.size() ? m.sector_edges[sector] : 90 * i;
        const std::string& label = m.sector_labels[static_cast<std::size_t>(i)];
        out.push_back({{"x", pixels(x)}, {"degrees", label.empty() ? degrees(turn) : label}});
    }
    return out;
}

double deviation_of(const BinHistogram& m, std::size_t bin) {
    const double sd = m.sd.empty() ? std::sqrt(std::max(m.expected[bin], 1.0)) : std::max(m.sd[bin], 1.0);
    return (m.observed[bin] - m.expected[bin]) / sd;
}

/// The bin that is furthest off, and a frame around its cell.
Json frame_of(const BinHistogram& m, const std::vector<double>& deviations) {
    const auto furthest = std::ranges::max_element(deviations, {}, [](double d) { return std::fabs(d); });
    const auto bin = static_cast<std::size_t>(furthest - deviations.begin()),
               sectors = static_cast<std::size_t>(m.sectors);
    constexpr double margin = 1.5;
    const double width = map_width / m.sectors, height = map_height / m.rings;
    return {{"drawn", fmt::format("{:.0f}", m.observed[bin])}, {"expected", fmt::format("{:.1f}", m.expected[bin])},
        {"deviation", fmt::format("{:+.1f}", *furthest)},
        {"x", pixels(map_left + width * static_cast<double>(bin % sectors) - margin)},
        {"y", pixels(map_top + height * static_cast<double>(bin / sectors) - margin)},
        {"width", pixels(width + 2 * margin)}, {"height", pixels(height + 2 * margin)}};
}

Json map_of(const BinHistogram& m) {
    Json out = {{"coordinates", m.coordinates}, {"sectors", m.sectors}, {"rings", m.rings}, {"bins", m.observed.size()},
        {"ring_ticks", ring_ticks(m)}, {"sector_ticks", sector_ticks(m)}, {"frame", false},
        {"sides",
            m.ring_axis.empty() ? "Degrees: theta downwards, phi to the right."
                                : m.ring_axis + " downwards, " + m.sector_axis + " to the right."},
        {"unit", m.ring_axis.empty() ? "1/sr" : "of its largest value"}};
    if (m.expected.empty()) {  // a density, 1/sr
        const double top = std::max(m.full_scale, 1e-300);
        out["top"] = fmt::format("{:.4g}", top);
        out["full_scale"] = fmt::format("{:.6g}", top);
        out["observed"] = fmt::format("{:.4g}", fmt::join(m.observed, ","));
        return out;
    }
    const double top = std::max(std::ranges::max(m.observed), std::ranges::max(m.expected));
    std::vector<double> deviations;
    for (std::size_t i = 0; i < m.observed.size(); ++i) deviations.push_back(deviation_of(m, i));
    out["frame"] = frame_of(m, deviations);
    out["top"] = fmt::format("{:.0f}", top);
    out["full_scale"] = fmt::format("{:.0f}", std::max(top, 1.0));
    out["observed"] = fmt::format("{:.0f}", fmt::join(m.observed, ","));
    out["expected_draws"] = fmt::format("{:.1f}", fmt::join(m.expected, ","));
    out["deviations"] = fmt::format("{:.2f}", fmt::join(deviations, ","));
    return out;
}

/// Draws and expectation over a line, or bars of the entries of a set.
Json line_of(const LineHistogram& h) {
    std::vector<double> heights = h.observed;
    heights.insert(heights.end(), h.expected.begin(), h.expected.end());
    heights.push_back(0);
    Axis x = linear_axis(h.axis, {h.edges.front(), h.edges.back()});
    x.low = h.edges.front();
    x.high = h.edges.back();
    Chart chart(640, 240, x, linear_axis("draws", heights), "Draws over " + h.axis);
    std::vector<Point> expected;
    for (std::size_t i = 0; i < h.observed.size(); ++i) {
        const double from = h.edges[i], to = h.edges[i + 1];
        if (h.observed[i] > 0) chart.band({from, to}, {0, 0}, {h.observed[i], h.observed[i]}, "c1");
        if (h.expected.empty()) continue;
        expected.push_back({from, h.expected[i]});
        expected.push_back({to, h.expected[i]});
    }
    if (!expected.empty()) chart.line(expected, "c2");
    return {{"chart", chart.str()}, {"of", h.entries ? "entries" : "intervals of x"}, {"has_p", !h.expected.empty()}};
}

/// The points of a polar curve over the angles of the plane of incidence, scaled to its largest value.
std::string curve(const std::vector<double>& v) {
    const double top = std::max(std::ranges::max(v), 1e-300);
    std::string out;
    for (std::size_t i = 0; i < v.size(); ++i) {
        const double angle = (static_cast<double>(i) - 89) * pi / 180, r = 170 * v[i] / top;
        out += fmt::format("{:.1f},{:.1f} ", 210 + r * math::sin(angle), 195 - r * math::cos(angle));
    }
    return out;
}

Json rose_of(const WeightHistogram& w) {
    if (w.rose_p.empty()) return false;
    Json spokes = Json::array();
    for (int angle = -90; angle <= 90; angle += 30) {
        const double s = math::sin(angle * pi / 180), c = math::cos(angle * pi / 180);
        spokes.push_back({{"x", pixels(210 + 172 * s)}, {"y", pixels(195 - 172 * c)}, {"text_x", pixels(210 + 186 * s)},
            {"text_y", pixels(std::abs(angle) == 90 ? 212 : 199 - 184 * c)}, {"degrees", angle}});
    }
    return {{"spokes", spokes}, {"f", curve(w.rose_f)}, {"p", curve(w.rose_p)}};
}

/// The density that the draws imply, by rings about n; null for any other verdict.
Json implied_of(const Verdict& v) {
    if (!v.implied) return {};
    Json rings = Json::array();
    for (const ImpliedDensity::Ring& r : v.implied->rings)
        rings.push_back({{"from", fmt::format("{:.0f}", r.from)}, {"to", fmt::format("{:.0f}", r.to)},
            {"density", fmt::format("{:.4g}", r.pdf)}, {"error", fmt::format("{:.2g}", r.error)}});
    return {{"rings", rings}};
}

Json devices_list(const CheckResult& j) {
    Json out = Json::array();
    for (const auto& [arm, device] : j.devices) out.push_back({{"arm", arm}, {"text", device.text()}});
    return out;
}

std::string title_of(const CheckResult& j) {
    std::vector<std::string> names;
    for (const Verdict& v : j.verdicts)
        if (std::ranges::find(names, v.arm) == names.end()) names.push_back(v.arm);
    return fmt::format(
        "{}: {}", names.size() == 1 ? names[0] : fmt::format("{} samplers", names.size()), word(j.state));
}

Json expected_of(const Verdict& v) { return {{"waived", v.waived}, {"why", v.why_expected}}; }

Json findings_list(const CheckResult& j) {
    Json out = Json::array();
    for (const Finding& f : findings_of(j))
        out.push_back({{"state", word(f.state)}, {"arm", f.arm}, {"text", describe(f)},
            {"expected", f.expected ? expected_of(*f.worst) : Json(false)}});
    return out;
}

bool starts_case(const std::vector<Verdict>& verdicts, std::size_t i) {
    return i == 0 || verdicts[i].check_case != verdicts[i - 1].check_case || verdicts[i].arm != verdicts[i - 1].arm;
}

/// The names of the tests, and the states of each case; the arm is named if there are several.
void add_matrix(const CheckResult& j, Json& to) {
    std::vector<std::string_view> tests;
    for (const Verdict& v : j.verdicts)
        if (std::ranges::find(tests, v.name) == tests.end()) tests.push_back(v.name);
    const bool has_one_arm =
        std::ranges::all_of(j.verdicts, [&](const Verdict& v) { return v.arm == j.verdicts[0].arm; });
    Json matrix = Json::array();
    for (std::size_t i = 0; i < j.verdicts.size(); ++i) {
        const Verdict& v = j.verdicts[i];
        if (starts_case(j.verdicts, i))
            matrix.push_back({{"arm", has_one_arm ? "" : v.arm}, {"case", v.check_case}, {"states", Json::array()}});
        matrix.back()["states"].push_back(word(v.state));
    }
    to["tests"] = tests;
    to["matrix"] = matrix;
}

/// Every case with its verdicts, maps, implied density and weights.
Json case_models(const CheckResult& j) {
    Json out = Json::array();
    std::size_t map = 0, line = 0, weight = 0;
    for (std::size_t i = 0; i < j.verdicts.size();) {
        const std::string arm = j.verdicts[i].arm, check_case = j.verdicts[i].check_case;
        const auto is_of_case = [&](const auto& list, std::size_t k) {
            return k < list.size() && list[k].arm == arm && list[k].check_case == check_case;
        };
        Json verdicts = Json::array(), implied = Json::array(), maps = Json::array(), weights = Json::array(),
             lines = Json::array();
        bool is_open = false;
        for (; is_of_case(j.verdicts, i); ++i) {
            const Verdict& v = j.verdicts[i];
            is_open = is_open || v.state == State::wrong || (v.state == State::inconclusive && !v.expected);
            verdicts.push_back({{"name", v.name}, {"state", word(v.state)}, {"text", describe(v)},
                {"expected", v.why_expected.empty() ? Json(false) : expected_of(v)}});
            if (const Json density = implied_of(v); !density.is_null()) implied.push_back(density);
        }
        is_open = is_open || (out.empty() && !implied.empty());  // only the first table of an implied density is open
        for (; is_of_case(j.maps, map); ++map) maps.push_back(map_of(j.maps[map]));
        for (; is_of_case(j.lines, line); ++line) lines.push_back(line_of(j.lines[line]));
        for (; is_of_case(j.weights, weight); ++weight)
            weights.push_back({{"histogram", histogram(j.weights[weight])}, {"rose", rose_of(j.weights[weight])}});
        out.push_back({{"arm", arm}, {"case", check_case}, {"open", is_open}, {"verdicts", verdicts}, {"maps", maps},
            {"lines", lines}, {"implied", implied}, {"weights", weights}});
    }
    return out;
}

}  // namespace

std::string verdict_html(const CheckResult& j, const ResultSource& source) {
    const Json findings = findings_list(j);
    const std::string left_out = skipped_text(j);
    Json model = {{"title", title_of(j)}, {"version", source.version}, {"commit", source.commit},
        {"command", source.command}, {"state", word(j.state)}, {"findings", findings}, {"unmet", j.unmet},
        {"left_out", left_out}, {"nothing_found", findings.empty() && j.unmet.empty() && left_out.empty()},
        {"statistical_tests", j.tests}, {"alpha", fmt::format("{:g}", j.alpha)}, {"screened", j.screened},
        {"confirmed", j.confirmed}, {"questions", j.questions > 0 ? std::to_string(j.questions) : ""},
        {"unseen", unseen_text(j)}, {"nothing_drawn", nothing_drawn_text(j)}, {"cases", case_models(j)},
        {"devices", devices_list(j)}};
    add_matrix(j, model);
    return render_page(check_templates(), "check.html", model);
}

}  // namespace crescent
