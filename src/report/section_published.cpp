// Every meter over seeds: the published value, the measured one, the band, and where in it the published value falls.
#include <set>

#include <fmt/format.h>

#include "report/arm_words.h"

namespace crescent::inline report {
namespace {

using html::words;

constexpr const char* published_prose = R"(
<p>A published figure is one draw from one stream of random numbers. What can be asked of it is whether it lies where
draws lie. In the strips the bar spans the middle 90 % of {seeds}, the tick is their median, the dot the {which} seed
({seed}) and the diamond the published value; each strip has its own scale. Beside each RMSE and variance stands the
tail index <i>k</i> of the samples of its region: from 1/2 on their variance is infinite.</p>
)";

constexpr const char* measured_prose = R"(
<p>In the strips the bar spans the middle 90 % of {seeds}, the tick is their median and the dot the first seed ({seed});
each strip has its own scale. Beside each RMSE and variance stands the tail index <i>k</i> of the samples of its region:
from 1/2 on their variance is infinite.</p>
)";

std::string fallen(const BandMeter& b) {
    if (!b.published || !b.published_rank || b.band.seeds < 2) return "–";
    if (b.band.q05 == *b.published && b.band.q95 == *b.published) return "the same";
    if (*b.published_rank <= 0) return "none";
    if (*b.published_rank >= 1) return "all";
    return percent(*b.published_rank, 2);
}

std::vector<html::Cell> band_row(const Page& page, const BandMeter& b, bool published) {
    Strip strip{b.band.q05, b.band.median, b.band.q95, b.measured, !b.band.heavy && b.band.seeds > 1,
        b.published.has_value(), b.published.value_or(0)};
    std::vector<html::Cell> row{html::heading(run_html(b.key, page.in.experiment))};
    if (published) row.push_back(html::figure(b.published ? figures_of(b.meter, *b.published) : ""));
    row.push_back(html::figure(figures_of(b.meter, b.measured)));
    row.push_back(html::figure(figures_of(b.meter, b.band.median)));
    row.push_back({interval_html(b.meter, b.band), true});
    row.push_back(words(strip_svg(strip)));
    if (published) row.push_back({fallen(b), true});
    row.push_back(html::figure(tail_html(page.find.tail(b))));
    return row;
}

std::vector<html::Cell> header(bool published) {
    std::vector<html::Cell> head{words("Run")};
    if (published) head.push_back({"Published", true});
    head.insert(head.end(), {{"Measured", true}, {"Median", true}, {"5–95 %", true}, words("Strip")});
    if (published) head.push_back({"Seeds below published", true});
    head.push_back({"<i>k</i>", true});
    return head;
}

/// Meters in the order they are told; whatever else was measured follows, without the whole frame.
std::vector<std::string> meters_in_order(const Page& page) {
    std::vector<std::string> order = headline_meters(page.in.experiment);
    std::set<std::string> seen(order.begin(), order.end());
    for (const BandMeter& b : page.in.metrics.bands)
        if (b.meter != "rmse_frame" && seen.insert(b.meter).second) order.push_back(b.meter);
    return order;
}

/// What the command line changed of the experiment whose figures were published; "" where nothing.
std::string changes(const Experiment& e) {
    std::string list;
    for (const std::string& change : e.overrides)
        if (!change.starts_with("seed=") && !change.starts_with("seeds="))
            list += (list.empty() ? "" : ", ") + ("<code>" + escape(change) + "</code>");
    if (list.empty()) return {};
    return "<p><strong>This run differs from the published one</strong> in " + list +
        ": the published figures stand beside it to show what the change does, not to be met.</p>";
}

}  // namespace

PageSection published(Page& page) {
    const bool published = page.find.anything_published();
    const Experiment& e = page.in.experiment;
    html::Table table(published ? "Published beside measured" : "Every meter of every run", header(published));
    for (const std::string& meter : meters_in_order(page)) {
        bool first = true;
        for (const BandMeter& b : page.in.metrics.bands) {
            if (b.meter != meter) continue;
            if (first) table.group(meter_html(meter));
            first = false;
            table.row(band_row(page, b, published));
        }
    }
    if (table.empty()) return {};
    const std::string prose = published ? published_prose : measured_prose;
    const std::string intro =
        fmt::format(fmt::runtime(prose), fmt::arg("seeds", plural(static_cast<std::uint64_t>(e.seeds), "seed")),
            fmt::arg("seed", e.seed), fmt::arg("which", page.seed_name()));
    return {"published", published ? "Published and measured" : "All meters",
        (published ? changes(e) : "") + intro + "<div class=\"wide\">" + table.str() + "</div>" +
            page.figures.plates(PlateKind::meters)};
}

}  // namespace crescent::inline report
