// Shot 13: the same run with other seeds: the spread of every value, and the place of the published one.
#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "shots.h"

namespace crescent::explainer {

namespace {

enum class Verdict { none, reproduced, outside, heavy };

struct Row {
    Words name, arm;
    Colour ink;
    std::vector<double> seeds;  // as ratios to the median
    double low = 1, high = 1;
    std::optional<double> published;
    Verdict verdict = Verdict::none;
};

constexpr double span = 4;  // the strip covers a quarter of the median to four times it

double across(double ratio) { return 0.5 + 0.5 * math::log(std::clamp(ratio, 1 / span, span)) / math::log(span); }

Verdict verdict_of(const SeedSpread& b) {
    if (!b.published) return Verdict::none;
    if (b.band.heavy) return Verdict::heavy;
    return *b.published >= b.band.q05 && *b.published <= b.band.q95 ? Verdict::reproduced : Verdict::outside;
}

std::vector<Row> rows_of(const Data& data) {
    const Cast& c = data.cast;
    const std::vector<std::pair<std::string, Words>> meters = {{"rmse." + c.highlight, Words("RMSE, highlight")},
        {"rmse." + c.surround, Words("RMSE, surround")}, {"fireflies", Words("fireflies")},
        {"y_mean", Words("mean of the frame")}};
    std::vector<Row> rows;
    for (const auto& [metric, words] : meters) {
        for (const std::string& arm : {c.cosine, c.phong}) {
            const RunKey key = data.key(arm);
            const auto band = std::ranges::find_if(
                data.metrics.bands, [&](const SeedSpread& b) { return b.metric == metric && b.key == key; });
            if (band == data.metrics.bands.end() || !(band->band.median > 0)) continue;
            Row row{words, Words(data.arm(arm)), data.ink(arm), {}, band->band.q05 / band->band.median,
                band->band.q95 / band->band.median, {}, verdict_of(*band)};
            for (const RunMetrics& run : data.metrics.runs)
                if (run.key.arm == arm && run.key.n == key.n && run.key.s == key.s)
                    row.seeds.push_back(metric_value(run, metric) / band->band.median);
            if (band->published) row.published = *band->published / band->band.median;
            rows.push_back(std::move(row));
        }
    }
    return rows;
}

Words verdict_text(Verdict v) {
    switch (v) {
        case Verdict::reproduced: return Words("reproduced");
        case Verdict::outside: return Words("outside");
        case Verdict::heavy: return Words("inconclusive: heavy tail");
        case Verdict::none: break;
    }
    return {};
}

Words counted(const std::vector<Row>& rows) {
    const auto count_of = [&](Verdict v) {
        return count(std::uint64_t(std::ranges::count(rows, v, &Row::verdict)), "verdicts of the strips");
    };
    return Words("Reproduced: ", count_of(Verdict::reproduced), ". Outside: ", count_of(Verdict::outside),
        ". Inconclusive, for their tail: ", count_of(Verdict::heavy), ".");
}

void strip(Frame& f, const Row& row, const Rect& r, double in, double bars, double diamonds) {
    const double y = r.y + r.h / 2;
    f.line({r.x, y}, {r.right(), y}, rule, 2, in);
    f.line({r.x + r.w / 2, r.y + 10}, {r.x + r.w / 2, r.bottom() - 10}, rule, 2, in);
    const double x0 = r.x + r.w * across(row.low), x1 = r.x + r.w * across(row.high);
    if (row.verdict != Verdict::heavy) f.fill({x0, y - 16, std::max(x1 - x0, 3.0), 32}, row.ink, 0.35 * bars);
    for (const double v : row.seeds) f.dot({r.x + r.w * across(v), y}, 6, row.ink, 0.8 * in);
    if (!row.published) return;
    const double x = r.x + r.w * across(*row.published);
    f.polygon({{x, y - 17}, {x + 17, y}, {x, y + 17}, {x - 17, y}}, ground, diamonds);
    f.polygon({{x, y - 13}, {x + 13, y}, {x, y + 13}, {x - 13, y}}, bright, diamonds);
}

}  // namespace

Shot seeds(const Data& data) {
    const std::vector<Row> rows = rows_of(data);
    const bool has_published = std::ranges::any_of(rows, [](const Row& r) { return r.published.has_value(); });
    Shot shot;
    shot.name = "seeds";
    shot.kind = Kind::backend;
    const Number n = count(std::uint64_t(data.experiment.seeds), "seeds of the experiment");
    shot.title = Words("Other random numbers: ", n, data.experiment.seeds == 1 ? " seed" : " seeds");
    shot.description = Words(
        "A row for each figure and arm: a dot a seed, a bar over the middle nine tenths of them, a diamond for the "
        "published figure, "
        "and the verdict.");
    shot.cues = {{0.5, Words("One run is one draw. Each dot is the same figure from another seed.")},
        {6,
            has_published ? Words("The diamond is the published figure, the bar the middle nine tenths of the seeds.")
                          : Words("The bar spans the middle nine tenths of the seeds.")}};
    if (has_published) shot.cues.push_back({11.8, counted(rows)});
    shot.seconds = has_published ? 17 : 11.8;
    shot.still = shot.seconds - 1;
    const std::vector<Row> shot_rows = rows;
    shot.draw = [=](Frame& f) {
        const double bars = f.ease(6, 6.6), diamonds = f.ease(7, 7.6);
        f.text({570, 838, 200, 40}, Words("÷ ", number(span, 2, "scale of the strips")), small_text, f.ease(0.5, 1.1));
        f.text({870, 838, 220, 40}, Words("median"), with(small_text, Align::centre), f.ease(0.5, 1.1));
        f.text({1190, 838, 200, 40}, Words("× ", number(span, 2, "scale of the strips")),
            with(small_text, Align::right), f.ease(0.5, 1.1));
        for (std::size_t k = 0; k < shot_rows.size(); ++k) {
            const Row& row = shot_rows[k];
            const double y = 124 + 88.0 * double(k), in = f.ease(0.5 + 0.6 * double(k), 1.1 + 0.6 * double(k));
            f.text({70, y, 320, 70}, row.name, with(with_px(label_text, 32), bright), in);
            f.text({390, y, 180, 70}, row.arm, with(with_px(label_text, 32), row.ink), in);
            strip(f, row, {570, y, 820, 70}, in, bars, diamonds);
            const Colour ink = row.verdict == Verdict::reproduced ? plates::series[4]
                : row.verdict == Verdict::outside                 ? plates::series[3]
                                                                  : muted;
            const Words verdict = verdict_text(row.verdict);
            if (!verdict.empty())
                f.text({1420, y, 440, 70}, verdict, with(with_px(label_text, 32), ink),
                    f.ease(8 + 0.35 * double(k), 8.4 + 0.35 * double(k)));
        }
    };
    return shot;
}

}  // namespace crescent::explainer
