// Sentences that compare two arms. They are put together from the values, so that they turn round when the values do,
// and they rank nothing whose intervals overlap or whose tail leaves no interval.
#include <fmt/format.h>

#include "report/page.h"

namespace crescent {
namespace {

std::string first_words(const Comparison& c, std::uint64_t n, const std::string& meter) {
    const std::string larger = escape(c.larger), smaller = escape(c.smaller);
    if (c.equal)
        return fmt::format("At <i>N</i> = {} and the first seed, {} and {} read the same {}, {}.", n, larger, smaller, meter,
                           html::value(figures(c.high)));
    return fmt::format("At <i>N</i> = {} and the first seed, {}’s {} is <b>{} times</b> {}’s ({} against {}).", n, larger,
                       meter, times(c.ratio), smaller, html::value(figures(c.high)), html::value(figures(c.low)));
}

std::string heavy_words(const Page& page, const BandMeter& a, const BandMeter& b) {
    std::string names;
    for (const BandMeter* band : {&a, &b}) {
        if (!band->band.heavy) continue;
        const auto tail = page.find.tail(*band);
        names += (names.empty() ? "" : " and ") + escape(band->key.arm);
        if (tail) names += fmt::format(" (tail index {})", html::value(tail_html(tail)));
    }
    return fmt::format(" How large the ratio is stays <b>inconclusive: heavy tail</b>: the samples of {} spread so widely "
                       "there that no interval means anything.", names);
}

std::string ranking(const Page& page, const BandMeter& a, const BandMeter& b) {
    if (a.band.heavy || b.band.heavy) return heavy_words(page, a, b);
    if (a.band.seeds < 2) return " One seed gives no interval, so the two are not ranked.";
    const bool overlap = a.band.q05 <= b.band.q95 && b.band.q05 <= a.band.q95;
    return overlap ? " The 5–95 % bands overlap, so the two are not ranked."
                   : " The 5–95 % bands over seeds do not overlap.";
}

}  // namespace

std::string ordering_sentence(const Page& page, const std::string& a, const std::string& b, std::uint64_t n,
                              const std::string& region) {
    const auto of_a = page.find.rmse(a, n, region), of_b = page.find.rmse(b, n, region);
    if (!of_a || !of_b) return {};
    const Comparison c = compare(a, *of_a, b, *of_b);
    const std::string meter = "rmse." + region;
    std::string out = first_words(c, n, meter_html(meter));
    const SeedCount seeds = page.find.seeds_above(c.larger, c.smaller, n, region);
    if (seeds.of > 1 && !c.equal) out += fmt::format(" The order is the same in {} of {} seeds.", seeds.held, seeds.of);
    const BandMeter *band_a = page.find.band(a, n, meter), *band_b = page.find.band(b, n, meter);
    if (band_a && band_b) out += ranking(page, *band_a, *band_b);
    return out;
}

}  // namespace crescent
