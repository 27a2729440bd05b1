// The model of every metric over seeds (published value, measured one, band, place of the published value in it), of
// the article's explanations that do not hold, and of the published values outside the bands.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <set>

#include "math/functions.h"
#include "output/charts.h"
#include "report/page.h"

namespace crescent {
namespace {

/// The share of seeds below the published value.
std::string share_below(const SeedSpread& b) {
    if (!b.published || !b.published_rank || b.band.seeds < 2) return "–";
    if (b.band.q05 == *b.published && b.band.q95 == *b.published) return "the same";
    if (*b.published_rank <= 0) return "none";
    if (*b.published_rank >= 1) return "all";
    return percent(*b.published_rank, 2);
}

Json band_row(const Page& page, const SeedSpread& b) {
    const Strip strip{.q05 = b.band.q05,
        .median = b.band.median,
        .q95 = b.band.q95,
        .measured = b.measured,
        .bar = !b.band.heavy && b.band.seeds > 1,
        .has_published = b.published.has_value(),
        .published = b.published.value_or(0)};
    const bool paired = page.in.experiment.reference.kind == ReferenceKind::paired;
    return {{"run", run_html(b.key, page.in.experiment)},
        {"published", cell_text(b.published ? figures_of(b.metric, *b.published) : "")},
        {"measured", cell_text(figures_of(b.metric, b.measured, paired))},
        {"median", cell_text(figures_of(b.metric, b.band.median, paired))},
        {"interval", interval_html(b.metric, b.band)}, {"strip", strip_svg(strip)}, {"below", share_below(b)},
        {"tail", cell_text(tail_text(page.find.tail(b)))}};
}

/// Returns the metrics in a fixed order, then all others, without the whole frame.
std::vector<std::string> metrics_in_order(const Page& page) {
    std::vector<std::string> order = headline_metrics(page.in.experiment);
    std::set<std::string> metrics(order.begin(), order.end());
    for (const SeedSpread& b : page.in.metrics.bands)
        if (b.metric != "rmse_frame" && metrics.insert(b.metric).second) order.push_back(b.metric);
    return order;
}

/// Returns what the command line changed of the experiment with published values.
Json changes_of(const Experiment& e) {
    Json out = Json::array();
    for (const std::string& change : e.overrides)
        if (!change.starts_with("seed=") && !change.starts_with("seeds=")) out.push_back({{"change", change}});
    return with_commas(std::move(out));
}

}  // namespace

Json all_metrics(Page& page) {
    const bool published = page.find.anything_published();
    Json groups = Json::array();
    for (const std::string& metric : metrics_in_order(page)) {
        Json rows = Json::array();
        for (const SeedSpread& b : page.in.metrics.bands)
            if (b.metric == metric) rows.push_back(band_row(page, b));
        if (!rows.empty()) groups.push_back({{"metric", metric_html(metric)}, {"rows", std::move(rows)}});
    }
    if (groups.empty()) return false;
    return {{"changes", published ? changes_of(page.in.experiment) : Json::array()}, {"columns", published ? 8 : 6},
        {"groups", std::move(groups)}, {"plates", page.figures.plates(PlateKind::meters)}};
}

// ---- Three explanations of the article that do not hold, each with the measurement that shows it; points without a
// measurement are omitted.

namespace {

// ---- Charts and sentences for these explanations. Furnaces are grouped by arithmetic and bits of u, one panel each;
// values above the axis are drawn at its top. Lost light is compared with (1 - cos theta_R)/2 with bars of two standard
// errors, rejections with their intervals.

/// One panel: an arithmetic and a resolution of u.
struct Series {
    std::string arithmetic;
    int u_bits = 0;
    std::vector<const FurnaceQuantiles*> sample_counts;  // by n
    std::string name() const { return fmt::format("{}, u of {} bits", arithmetic, u_bits); }
};

std::vector<Series> series_of(const Evidence& evidence) {
    std::vector<Series> series;
    for (const FurnaceQuantiles& q : evidence.furnace) {
        auto entry = std::find_if(series.begin(), series.end(),
            [&](const Series& s) { return s.arithmetic == q.arithmetic && s.u_bits == q.u_bits; });
        if (entry == series.end()) entry = series.insert(series.end(), {q.arithmetic, q.u_bits, {}});
        entry->sample_counts.push_back(&q);
    }
    for (Series& s : series)
        std::sort(
            s.sample_counts.begin(), s.sample_counts.end(), [](const auto* a, const auto* b) { return a->n < b->n; });
    return series;
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
    const auto limit_to_axis = [&](std::vector<double> v) {
        for (double& x : v) x = std::min(x, y.high);
        return v;
    };
    Chart chart(420, 280, log_axis("N", n), y, "Combined furnace of the Phong arm against N: " + s.name());
    chart.band(n, limit_to_axis(column(s, &FurnaceQuantiles::q05)), limit_to_axis(column(s, &FurnaceQuantiles::q95)),
        "c1 faint");
    chart.band(
        n, limit_to_axis(column(s, &FurnaceQuantiles::q25)), limit_to_axis(column(s, &FurnaceQuantiles::q75)), "c1");
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
    const auto distance_of = [&](const FurnaceQuantiles* q) {
        return std::fabs(math::log(static_cast<double>(q->n) / n));
    };
    return *std::min_element(s.sample_counts.begin(), s.sample_counts.end(),
        [&](const auto* a, const auto* b) { return distance_of(a) < distance_of(b); });
}

std::string share_text(const FalseRejection& r) {
    return percent(r.runs > 0 ? static_cast<double>(r.rejected) / r.runs : 0, 3);
}

/// Draws quantiles of the combined Phong furnace against N: one panel per arithmetic and resolution of u, with its
/// name.
Json furnace_charts(const Page& page) {
    Json out = Json::array();
    for (const Series& s : series_of(page.in.evidence)) out.push_back(panel(page, s));
    return out;
}

/// Medians by N, one cell per panel.
Json furnace_medians(const Evidence& evidence) {
    const auto series = series_of(evidence);
    std::set<std::uint64_t> sample_counts;
    for (const Series& s : series)
        for (const FurnaceQuantiles* q : s.sample_counts) sample_counts.insert(q->n);
    Json out = Json::array();
    for (const std::uint64_t n : sample_counts) {
        Json cells = Json::array();
        for (const Series& s : series) {
            const auto match = std::ranges::find(s.sample_counts, n, [](const FurnaceQuantiles* q) { return q->n; });
            cells.push_back(cell_text(match == s.sample_counts.end() ? "" : figures((*match)->median)));
        }
        out.push_back({{"n", n}, {"cells", cells}});
    }
    return out;
}

/// Returns whether double precision is too low in the same way as single precision, near the N of the furnace that was
/// run; "" with one panel.
std::string furnace_html(const Page& page) {
    const Evidence& evidence = page.in.evidence;
    const auto series = series_of(evidence);
    const auto coarse = std::min_element(series.begin(), series.end(), [](const Series& a, const Series& b) {
        return std::pair(a.arithmetic, a.u_bits) < std::pair(b.arithmetic, b.u_bits);
    });
    const auto fine = std::max_element(series.begin(), series.end(), [](const Series& a, const Series& b) {
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

/// Draws the diffuse part that the Phong sampler cannot reach, against the tilt: <svg>.
std::string lost_chart(const Evidence& evidence) {
    std::vector<double> angles{0}, shares{0};
    std::vector<Point> theory, estimates;
    for (const LostSupport& l : evidence.lost) {
        angles.push_back(l.theta_R_deg);
        shares.insert(shares.end(), {l.theory, std::max(0.0, l.measured)});
        estimates.push_back({l.theta_R_deg, l.measured});
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
    chart.dots(estimates, "c1");
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

/// Draws how often a t-test rejects a correct estimate, against N: <svg>.
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
        const bool is_infinite = r.k > 0.5, is_above = r.low > evidence.alpha;
        (is_infinite ? heavy : light) += 1;
        (is_infinite ? heavy_above : light_above) += is_above;
        if (is_infinite && is_above && (!worst || r.low > worst->low)) worst = &r;
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

Json furnace_point(const Page& page) {
    const Evidence& e = page.in.evidence;
    if (e.furnace.empty() || !(e.rho_d > 0)) return false;  // without Lambert the furnace is not too low
    Json caps = Json::array();
    for (const FurnaceCap& cap : e.caps) caps.push_back({{"y", with_minus(figures(cap.y))}, {"bits", cap.u_bits}});
    return {{"k", figures((e.s - 1) / (e.s + 1), 3)}, {"caps", with_commas(std::move(caps))},
        {"sentence", furnace_html(page)}, {"panels", furnace_charts(page)}, {"expected", figures(e.expected)},
        {"medians", furnace_medians(e)}};
}

Json lost_point(const Evidence& e) {
    if (e.lost.empty()) return false;
    return {{"sentence", lost_html(e)}, {"chart", lost_chart(e)}};
}

Json rejection_point(const Evidence& e) {
    if (e.rejections.empty()) return false;
    return {{"alpha", shortest(e.alpha)}, {"alpha_percent", percent(e.alpha)}, {"n", e.rejections.front().n},
        {"sentence", rejection_html(e)}, {"rows", rejection_rows(e)}, {"chart", rejection_chart(e)}};
}

}  // namespace

Json where_wrong(const Page& page) {
    const Evidence& e = page.in.evidence;
    Json out = {{"rho_d", figures(e.rho_d)}, {"rho_s", figures(e.rho_s)}, {"s", shortest(e.s)},
        {"furnace", furnace_point(page)}, {"lost", lost_point(e)}, {"rejections", rejection_point(e)}};
    if (out["furnace"] == false && out["lost"] == false && out["rejections"] == false) return false;
    return out;
}

// ---- Published values outside the bands of this run, and possible reasons; only reasons for which this run has the
// numbers are given. docs/scene.md explains how the geometry was inferred.

namespace {

std::string signed_percent(double fraction) {
    const double tenths = std::round(1000 * fraction);
    return html::value(tenths == 0 ? "0.0 %" : fmt::format("{:+.1f} %", tenths / 10));
}

std::optional<double> relative(const SeedSpread* b) {
    if (!b || !b->published || *b->published == 0) return {};
    return b->band.median / *b->published - 1;
}

/// Returns "18 to 22 % below", for deviations of one sign; empty if the signs differ or nothing was published.
std::string spread(const std::vector<double>& values) {
    if (values.empty()) return {};
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (*low < 0 && *high > 0) return {};
    const double smallest = std::min(std::fabs(*low), std::fabs(*high)),
                 largest = std::max(std::fabs(*low), std::fabs(*high));
    const std::string range = largest - smallest < 0.005
        ? fmt::format("{:.0f}", 100 * largest)
        : fmt::format("{:.0f} to {:.0f}", 100 * smallest, 100 * largest);
    return range + " % " + (*low < 0 ? "below" : "above");
}

/// The broad arms in the highlight, and why the geometry cannot simply be changed to match them.
std::string highlight_remark(const Page& page, const std::string& region) {
    std::string parts;
    bool is_below = true;
    for (const char* kind : {"rmse.", "var."}) {
        std::vector<double> ratios;
        for (const ArmPlan* arm : arms_about_normal(page.in.experiment))
            if (const auto r = relative(page.find.band(arm->name, page.find.headline_n(), kind + region)))
                ratios.push_back(*r);
        const std::string range = spread(ratios);
        if (range.empty()) continue;
        is_below = is_below && ratios.front() < 0;
        parts += (parts.empty() ? "" : ", ") + metric_html(kind + region) + " " + range;
    }
    if (parts.empty()) return {};
    std::string out = "For the arms that do not follow the lobe, medians against the published values: " + parts + ".";
    const auto& control = page.in.experiment.exponent;
    if (!is_below || !control || control->s.empty()) return out;
    const double s = *std::max_element(control->s.begin(), control->s.end());
    const auto mean = relative(page.find.band(control->arm, control->n, "y_mean", s));
    if (mean && *mean > 0)
        out += fmt::format(
            " Matching them would need a highlight of more pixels, i.e. a larger {}, which would raise {} at <i>s</i> "
            "= {} further; it is {} already. No single geometry matches both.",
            escape(control->shape), metric_html("y_mean"), shortest(s), signed_percent(*mean));
    return out;
}

/// Deviations of one metric over the exponent control.
std::string exponent_remark(const Page& page, const std::string& metric) {
    const auto& control = page.in.experiment.exponent;
    if (!control) return {};
    std::string values;
    for (const double s : control->s)
        if (const auto r = relative(page.find.band(control->arm, control->n, metric, s)))
            values += fmt::format("{}{} at <i>s</i> = {}", values.empty() ? "" : ", ", signed_percent(*r), shortest(s));
    if (values.empty()) return {};
    return fmt::format("For {}, {}: {}.", escape(control->arm), metric_html(metric), values);
}

/// Returns the largest deviation of log RMSE from a slope of -1/2, as a fraction.
double departure(const std::vector<std::uint64_t>& n, const std::vector<double>& rmse) {
    double mean = 0, worst = 0;
    for (std::size_t i = 0; i < n.size(); ++i)
        mean += math::log(rmse[i] * std::sqrt(static_cast<double>(n[i]))) / static_cast<double>(n.size());
    for (std::size_t i = 0; i < n.size(); ++i)
        worst = std::max(worst, std::fabs(math::log(rmse[i] * std::sqrt(static_cast<double>(n[i]))) - mean));
    return worst;
}

std::vector<double> ladder_of(const Page& page, const ArmPlan& arm, const std::string& region, std::uint32_t seed) {
    std::vector<double> out;
    for (const std::uint64_t n : arm.n) {
        const RunMetrics* run = page.find.run({arm.name, n, page.find.s(), seed});
        const RegionMetrics* metric = run ? run->region(region) : nullptr;
        if (!metric || !(metric->rmse > 0)) return {};
        out.push_back(metric->rmse);
    }
    return out;
}

/// A published ladder that is smoother than that of most seeds, for an arm with a heavy tail.
std::string smooth_ladder_remark(const Page& page, const ArmPlan& narrow, const std::string& region) {
    std::vector<double> published;
    for (const std::uint64_t n : narrow.n)
        if (const SeedSpread* b = page.find.band(narrow.name, n, "rmse." + region); b && b->published)
            published.push_back(*b->published);
    if (published.size() < 3 || published.size() != narrow.n.size()) return {};
    const double limit = departure(narrow.n, published);
    int close_count = 0, count = 0;
    for (const std::uint32_t seed : page.in.provenance.seeds) {
        const auto ladder = ladder_of(page, narrow, region, seed);
        if (ladder.empty()) continue;
        ++count;
        if (departure(narrow.n, ladder) <= limit) ++close_count;
    }
    if (count < 2) return {};
    return fmt::format(
        "The published ladder of {} in {} deviates from slope −1/2 by at most {}. Of {} seeds here, {} keep as "
        "close: the others meet a rare bright sample at some sample count.",
        escape(narrow.name), escape(region), percent(limit, 2), count, close_count);
}

/// A published rise of RMSE with N, for an arm whose square has no finite expectation.
std::string rise_remark(const Page& page, const ArmPlan& narrow, const std::string& region) {
    for (std::size_t i = 1; i < narrow.n.size(); ++i) {
        const SeedSpread *a = page.find.band(narrow.name, narrow.n[i - 1], "rmse." + region),
                         *b = page.find.band(narrow.name, narrow.n[i], "rmse." + region);
        if (!a || !b || !a->published || !b->published || *b->published <= *a->published) continue;
        const double factor = *b->published / *a->published;
        int rise_count = 0, large_rise_count = 0, count = 0;
        for (const std::uint32_t seed : page.in.provenance.seeds) {
            const auto ladder = ladder_of(page, narrow, region, seed);
            if (ladder.empty()) continue;
            ++count;
            rise_count += ladder[i] > ladder[i - 1];
            large_rise_count += ladder[i] >= factor * ladder[i - 1];
        }
        if (count < 2) return {};
        return fmt::format(
            "From <i>N</i> = {} to {} the published {} of {} rises by a factor of {:.2f}. In {} of {} seeds here it "
            "rises, in {} by that much. With an infinite variance behind it, it need not fall.",
            narrow.n[i - 1], narrow.n[i], metric_html("rmse." + region), escape(narrow.name), factor, rise_count, count,
            large_rise_count);
    }
    return {};
}

Json remarks(const Page& page) {
    std::vector<std::string> list;
    const ArmPair pair = arm_pair(page);
    const ArmPlan *broad = pair.broad, *narrow = pair.narrow;
    if (pair) {
        const std::string hot = page.find.region_where_worst(broad->name, narrow->name, page.find.headline_n());
        const std::string cold = page.find.region_where_worst(narrow->name, broad->name, page.find.headline_n());
        if (!hot.empty()) list.push_back(highlight_remark(page, hot));
        if (!cold.empty() && cold != hot)
            if (const auto r = relative(page.find.band(broad->name, page.find.headline_n(), "rmse." + cold)))
                list.push_back(fmt::format(
                    "For {}, {}: {}.", escape(broad->name), metric_html("rmse." + cold), signed_percent(*r)));
        for (const char* metric : {"fireflies", "y_mean", "horizon_frac"})
            list.push_back(exponent_remark(page, metric));
        if (!hot.empty()) list.push_back(smooth_ladder_remark(page, *narrow, hot));
        if (!cold.empty()) list.push_back(rise_remark(page, *narrow, cold));
    }
    std::erase_if(list, [](const std::string& remark) { return remark.empty(); });
    return list;
}

}  // namespace

Json disagreements(const Page& page) {
    if (!page.find.anything_published()) return false;
    Json rows = Json::array();
    std::size_t checked_count = 0;
    for (const SeedSpread& b : page.in.metrics.bands) {
        if (!b.published || b.band.heavy || b.band.seeds < 2) continue;
        ++checked_count;
        if (*b.published >= b.band.q05 && *b.published <= b.band.q95) continue;
        const auto deviation = relative(&b);
        rows.push_back({{"metric", metric_html(b.metric)}, {"run", run_html(b.key, page.in.experiment)},
            {"published", cell_text(figures_of(b.metric, *b.published))},
            {"median", cell_text(figures_of(b.metric, b.band.median))}, {"interval", interval_html(b.metric, b.band)},
            {"off", deviation ? signed_percent(*deviation) : "–"}});
    }
    if (checked_count == 0) return false;
    const std::size_t disagreement_count = rows.size();
    return {{"compared", plural(checked_count, "published value")}, {"outside", disagreement_count},
        {"one_outside", disagreement_count == 1}, {"rows", std::move(rows)}, {"remarks", remarks(page)}};
}

}  // namespace crescent
