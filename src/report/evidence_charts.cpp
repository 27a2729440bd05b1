// Furnaces are grouped by arithmetic and bits of u, one panel each; values above the axis are drawn at its top. Lost
// light is compared with (1 - cos theta_R)/2 with bars of two standard errors, rejections with their intervals.
#include "report/evidence_charts.h"

#include "report/wording.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "math/functions.h"

namespace crescent::inline report {
namespace {

/// One panel: an arithmetic and a resolution of u.
struct Series {
    std::string arithmetic;
    int u_bits = 0;
    std::vector<const FurnaceQuantiles*> sample_counts;  // by n
    std::string name() const { return fmt::format("{}, u of {} bits", arithmetic, u_bits); }
};

std::vector<Series> series_of(const Evidence& evidence) {
    std::vector<Series> all;
    for (const FurnaceQuantiles& q : evidence.furnace) {
        auto found = std::find_if(all.begin(), all.end(),
            [&](const Series& s) { return s.arithmetic == q.arithmetic && s.u_bits == q.u_bits; });
        if (found == all.end()) found = all.insert(all.end(), {q.arithmetic, q.u_bits, {}});
        found->sample_counts.push_back(&q);
    }
    for (Series& s : all)
        std::sort(
            s.sample_counts.begin(), s.sample_counts.end(), [](const auto* a, const auto* b) { return a->n < b->n; });
    return all;
}

const FurnaceResult* combined_furnace(const Page& page) {
    const ArmPlan* arm = arm_about_mirror(page.in.experiment);
    for (const FurnaceResult& f : page.in.metrics.furnaces)
        if (arm && f.arm == arm->name && f.part == "combined") return &f;
    return nullptr;
}

std::optional<double> cap_of(const Evidence& evidence, int bits) {
    for (const FurnaceCap& cap : evidence.caps)
        if (cap.u_bits == bits) return cap.y;
    return {};
}

std::vector<double> column(const Series& s, double FurnaceQuantiles::* field) {
    std::vector<double> out;
    for (const FurnaceQuantiles* q : s.sample_counts) out.push_back(q->*field);
    return out;
}

Axis y_axis(const Evidence& evidence) {
    std::vector<double> values{evidence.expected};
    for (const FurnaceQuantiles& q : evidence.furnace)
        values.insert(values.end(), {q.q05, q.q25, q.median, q.q75, std::min(q.q95, 1.6 * evidence.expected)});
    return linear_axis("furnace reads, Y", values);
}

Json panel(const Page& page, const Series& s) {
    const Evidence& evidence = page.in.evidence;
    std::vector<double> n;
    for (const FurnaceQuantiles* q : s.sample_counts) n.push_back(static_cast<double>(q->n));
    const Axis y = y_axis(evidence);
    const auto held = [&](std::vector<double> v) {
        for (double& x : v) x = std::min(x, y.high);
        return v;
    };
    Chart chart(420, 280, log_axis("N", n), y, "Combined furnace of the Phong arm against N: " + s.name());
    chart.band(n, held(column(s, &FurnaceQuantiles::q05)), held(column(s, &FurnaceQuantiles::q95)), "c1 faint");
    chart.band(n, held(column(s, &FurnaceQuantiles::q25)), held(column(s, &FurnaceQuantiles::q75)), "c1");
    std::vector<Point> medians;
    for (const FurnaceQuantiles* q : s.sample_counts) medians.push_back({static_cast<double>(q->n), q->median});
    chart.line(medians, "c1");
    chart.dots(medians, "c1");
    chart.rule(evidence.expected, "strong", "expected");
    if (const auto cap = cap_of(evidence, s.u_bits))
        chart.rule(*cap, "dashed c0", fmt::format("limit of {} bits", s.u_bits));
    if (const FurnaceResult* f = combined_furnace(page); f && f->published)
        chart.diamonds({{static_cast<double>(f->n), *f->published}}, "pub");
    return {{"name", s.name()}, {"chart", chart.str()}};
}

/// Returns the sample count of the series nearest to n, on a log scale.
const FurnaceQuantiles* nearest_sample_count(const Series& s, double n) {
    const auto far = [&](const FurnaceQuantiles* q) { return std::fabs(math::log(static_cast<double>(q->n) / n)); };
    return *std::min_element(
        s.sample_counts.begin(), s.sample_counts.end(), [&](const auto* a, const auto* b) { return far(a) < far(b); });
}

std::string share_text(const FalseRejection& r) {
    return percent(r.runs > 0 ? static_cast<double>(r.rejected) / r.runs : 0, 3);
}

}  // namespace

Json furnace_charts(const Page& page) {
    Json out = Json::array();
    for (const Series& s : series_of(page.in.evidence)) out.push_back(panel(page, s));
    return out;
}

Json furnace_medians(const Evidence& evidence) {
    const auto all = series_of(evidence);
    std::set<std::uint64_t> sample_counts;
    for (const Series& s : all)
        for (const FurnaceQuantiles* q : s.sample_counts) sample_counts.insert(q->n);
    Json out = Json::array();
    for (const std::uint64_t n : sample_counts) {
        Json cells = Json::array();
        for (const Series& s : all) {
            const auto found = std::ranges::find(s.sample_counts, n, [](const FurnaceQuantiles* q) { return q->n; });
            cells.push_back(cell_text(found == s.sample_counts.end() ? "" : figures((*found)->median)));
        }
        out.push_back({{"n", n}, {"cells", cells}});
    }
    return out;
}

std::string furnace_html(const Page& page) {
    const Evidence& evidence = page.in.evidence;
    const auto all = series_of(evidence);
    const auto coarse = std::min_element(all.begin(), all.end(), [](const Series& a, const Series& b) {
        return std::pair(a.arithmetic, a.u_bits) < std::pair(b.arithmetic, b.u_bits);
    });
    const auto fine = std::max_element(all.begin(), all.end(), [](const Series& a, const Series& b) {
        return std::pair(a.arithmetic, a.u_bits) < std::pair(b.arithmetic, b.u_bits);
    });
    if (coarse == fine || evidence.expected <= 0) return {};
    const FurnaceResult* run = combined_furnace(page);
    const double n = run ? static_cast<double>(run->n) : static_cast<double>(fine->sample_counts.front()->n);
    const FurnaceQuantiles *low = nearest_sample_count(*coarse, n), *high = nearest_sample_count(*fine, n);
    const double short_low = 1 - low->median / evidence.expected, short_high = 1 - high->median / evidence.expected;
    std::string out = fmt::format(
        "At <i>N</i> = {} half of all furnaces read below {} in {} and below {} in {}, where {} is due: {} and {} "
        "short.",
        low->n, html::value(figures(low->median)), escape(coarse->name()), html::value(figures(high->median)),
        escape(fine->name()), html::value(figures(evidence.expected)), percent(short_low, 2), percent(short_high, 2));
    out += short_high > 0.5 * short_low
        ? " Nearly the same undershoot is in the finer arithmetic, so precision is not the cause."
        : " The finer arithmetic recovers most of it, so in this run precision does explain the undershoot.";
    return out;
}

std::string lost_chart(const Evidence& evidence) {
    std::vector<double> angles{0}, shares{0};
    std::vector<Point> theory, measured;
    for (const LostSupport& l : evidence.lost) {
        angles.push_back(l.theta_R_deg);
        shares.insert(shares.end(), {l.theory, std::max(0.0, l.measured)});
        measured.push_back({l.theta_R_deg, l.measured});
    }
    const Axis x = linear_axis("tilt of R from the normal, degrees", angles);
    for (int i = 0; i <= 60; ++i) {
        const double angle = x.low + (x.high - x.low) * i / 60;
        theory.push_back({angle, (1 - math::cos(angle * std::numbers::pi / 180)) / 2});
        shares.push_back(theory.back().y);
    }
    Chart chart(600, 320, x, linear_axis("share of the fill that is lost", shares),
        "Lost share of Lambert under the fill against the tilt of R");
    chart.line(theory, "c0");
    for (const LostSupport& l : evidence.lost)
        chart.bar(l.theta_R_deg, std::max(0.0, l.measured - 2 * l.se), l.measured + 2 * l.se, "c1");
    chart.dots(measured, "c1");
    return chart.str();
}

std::string lost_html(const Evidence& evidence) {
    std::vector<const LostSupport*> tilted;
    double worst = 0;
    for (const LostSupport& l : evidence.lost) {
        if (l.theta_R_deg > 0) tilted.push_back(&l);
        if (l.se > 0) worst = std::max(worst, std::fabs(l.measured - l.theory) / l.se);
    }
    const std::size_t stride = std::max<std::size_t>(1, (tilted.size() + 4) / 5);  // at most five of them in a sentence
    std::string values;
    for (std::size_t i = stride - 1; i < tilted.size(); i += stride)
        values += fmt::format("{}{} at {}°", values.empty() ? "" : ", ", html::value(percent(tilted[i]->measured)),
            shortest(tilted[i]->theta_R_deg));
    return fmt::format(
        "Measured by drawing from the cosine and asking the Phong density whether it could have drawn the same: {}. "
        "The largest departure from theory is {:.1f} standard errors{}.",
        values.empty() ? "nothing" : values, worst,
        worst <= 4 ? "" : ", more than chance allows: theory and measurement disagree here");
}

std::string rejection_chart(const Evidence& evidence) {
    std::vector<double> exponents, rates{0, evidence.alpha};
    std::vector<Point> points;
    for (const FalseRejection& r : evidence.rejections) {
        exponents.push_back(r.s);
        rates.insert(rates.end(), {r.low, r.high});
        points.push_back({r.s, r.runs > 0 ? static_cast<double>(r.rejected) / r.runs : 0});
    }
    Axis x = log_axis("exponent s", exponents);
    x.ticks = exponents;
    Chart chart(600, 320, x, linear_axis("share of runs rejected", rates),
        "Share of correct runs that a t-test rejects, against s");
    chart.rule(evidence.alpha, "dashed strong", fmt::format("what the test promises: {}", percent(evidence.alpha)));
    for (const FalseRejection& r : evidence.rejections) chart.bar(r.s, r.low, r.high, "c1");
    chart.dots(points, "c1");
    return chart.str();
}

Json rejection_rows(const Evidence& evidence) {
    Json out = Json::array();
    for (const FalseRejection& r : evidence.rejections)
        out.push_back({{"exponent", shortest(r.s)}, {"k", with_minus(fmt::format("{:.3f}", r.k))}, {"runs", r.runs},
            {"rejected", r.rejected}, {"rate", share_text(r)}, {"low", percent(r.low)}, {"high", percent(r.high)}});
    return out;
}

std::string rejection_html(const Evidence& evidence) {
    int heavy = 0, heavy_above = 0, light = 0, light_above = 0;
    const FalseRejection* worst = nullptr;
    for (const FalseRejection& r : evidence.rejections) {
        const bool infinite = r.k > 0.5, above = r.low > evidence.alpha;
        (infinite ? heavy : light) += 1;
        (infinite ? heavy_above : light_above) += above;
        if (infinite && above && (!worst || r.low > worst->low)) worst = &r;
    }
    const auto exponents = [](int count) { return plural(static_cast<std::uint64_t>(count), "exponent"); };
    std::string out;
    if (heavy > 0)
        out += fmt::format(
            "Of {} with <i>k</i> above 1/2, the arm is rejected more often than promised, interval included, at {}.",
            exponents(heavy), heavy_above);
    if (worst)
        out += fmt::format(" The worst is <i>s</i> = {}, where {} of the runs are rejected.", shortest(worst->s),
            html::value(share_text(*worst)));
    if (light > 0) out += fmt::format(" Of {} with <i>k</i> up to 1/2, at {}.", exponents(light), light_above);
    return out;
}

}  // namespace crescent::inline report
