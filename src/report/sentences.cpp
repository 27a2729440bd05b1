// Sentences that compare two arms. They are put together from the values, so that they turn round when the values do,
// and they rank nothing whose intervals overlap or whose tail leaves no interval.
#include <fmt/format.h>

#include "report/page.h"

namespace crescent::inline report {
namespace {

std::string first_words(const RatioOfErrors& c, std::uint64_t n, const std::string& meter, const std::string& seed) {
    const std::string larger = escape(c.larger), smaller = escape(c.smaller);
    if (c.equal)
        return fmt::format("At <i>N</i> = {} and the {} seed, {} and {} read the same {}, {}.", n, seed, larger,
            smaller, meter, html::value(figures(c.high)));
    return fmt::format("At <i>N</i> = {} and the {} seed, {}’s {} is <b>{} times</b> {}’s ({} against {}).", n, seed,
        larger, meter, times(c.ratio), smaller, html::value(figures(c.high)), html::value(figures(c.low)));
}

std::string heavy_words(const Page& page, const BandMeter& a, const BandMeter& b) {
    std::string names;
    for (const BandMeter* band : {&a, &b}) {
        if (!band->band.heavy) continue;
        const auto tail = page.find.tail(*band);
        names += (names.empty() ? "" : " and ") + escape(band->key.arm);
        if (tail) names += fmt::format(" (tail index {})", html::value(tail_html(tail)));
    }
    return fmt::format(
        " How large the ratio is stays <b>inconclusive: heavy tail</b>: the samples of {} spread so widely "
        "there that no interval means anything.",
        names);
}

std::string ranking(const Page& page, const BandMeter& a, const BandMeter& b) {
    if (a.band.heavy || b.band.heavy) return heavy_words(page, a, b);
    if (a.band.seeds < 2) return " One seed gives no interval, so the two are not ranked.";
    const bool overlap = a.band.q05 <= b.band.q95 && b.band.q05 <= a.band.q95;
    if (overlap) return " The <span class=\"v\">5–95 %</span> bands overlap, so the two are not ranked.";
    const double chance = chance_of_parted_bands(std::min(a.band.seeds, b.band.seeds));
    return chance > 0.05 ? fmt::format(
                               " With {} seeds the bands of equal arms lie apart in {} of all runs, so the two "
                               "are not ranked.",
                               std::min(a.band.seeds, b.band.seeds), percent(chance, 2))
                         : " The <span class=\"v\">5–95 %</span> bands over seeds do not overlap.";
}

html::Cell meter_cell(const Page& page, const BandMeter* band) {
    if (!band) return html::figure("");
    std::string out = html::number(figures_of(band->meter, band->measured));
    if (band->band.seeds > 1)
        out += fmt::format("<small>{} [{}]</small>", html::value(figures_of(band->meter, band->band.median)),
            interval_html(band->meter, band->band));
    if (const auto tail = page.find.tail(*band); tail && band->meter.starts_with("rmse."))
        out += fmt::format("<small>tail index {}</small>", html::value(tail_html(tail)));
    return {out, true};
}

}  // namespace

std::string meters_table(const Page& page, const std::string& caption_html, const std::vector<Column>& columns) {
    std::vector<html::Cell> head{html::words("Meter")};
    for (const Column& column : columns) head.push_back({column.title_html, true});
    html::Table table(caption_html, head);
    for (const std::string& meter : headline_meters(page.in.experiment)) {
        std::vector<html::Cell> row{html::heading(meter_html(meter))};
        bool any = false;
        for (const Column& column : columns) {
            const BandMeter* band = page.find.band(column.arm, column.n, meter, column.s);
            any = any || band;
            row.push_back(meter_cell(page, band));
        }
        if (any) table.row(row);
    }
    return table.empty() ? "" : table.str();
}

std::string ordering_sentence(
    const Page& page, const std::string& a, const std::string& b, std::uint64_t n, const std::string& region) {
    const auto of_a = page.find.rmse(a, n, region), of_b = page.find.rmse(b, n, region);
    if (!of_a || !of_b) return {};
    const RatioOfErrors c = compare(a, *of_a, b, *of_b);
    const std::string meter = "rmse." + region;
    std::string out = first_words(c, n, meter_html(meter), page.seed_name());
    const SeedCount seeds = page.find.seeds_above(c.larger, c.smaller, n, region);
    if (seeds.of > 1 && !c.equal) out += fmt::format(" The order is the same in {} of {} seeds.", seeds.held, seeds.of);
    const BandMeter *band_a = page.find.band(a, n, meter), *band_b = page.find.band(b, n, meter);
    if (band_a && band_b) out += ranking(page, *band_a, *band_b);
    return out;
}

}  // namespace crescent::inline report
