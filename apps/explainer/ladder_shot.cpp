// Up to four crops, evenly chosen from the ladder, appear from 5 s on, one every 2 s, the chart's points at the same
// time, then the line. The axes hold the ladders of both arms, so that both shots have the same scale.
#include "ladder_shot.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "drawing.h"
#include "words.h"

namespace crescent::explainer {

namespace {

constexpr double first = 5, interval = 2;  // s: when the first sample count appears, and the duration of each

std::vector<Point> points_of(const Ladder& ladder, const LogPlot& plot) {
    std::vector<Point> out;
    for (std::size_t k = 0; k < ladder.n.size(); ++k)
        if (ladder.rmse[k] > 0) out.push_back(plot.at(double(ladder.n[k]), ladder.rmse[k]));
    return out;
}

LogPlot plot_of(const Data& data) {
    LogPlot plot{{1080, 210, 700, 560}, 1e300, 0, 1e300, 0};
    for (const std::string& arm : {data.cast.cosine, data.cast.phong}) {
        const Ladder& ladder = ladder_of(data, arm);
        for (const double v : ladder.rmse)
            if (v > 0) {
                plot.y0 = std::min(plot.y0, v);
                plot.y1 = std::max(plot.y1, v);
            }
        plot.x0 = std::min(plot.x0, double(ladder.n.front()));
        plot.x1 = std::max(plot.x1, double(ladder.n.back()));
    }
    if (!(plot.y1 > plot.y0)) {
        plot.y0 = 0.5;
        plot.y1 = 2;
    }
    plot.y0 /= 1.4;
    plot.y1 *= 1.4;
    plot.x0 /= 1.35;
    plot.x1 *= 1.35;
    return plot;
}

/// Returns the four sample counts that are shown, evenly chosen.
std::vector<std::size_t> shown_of(const Ladder& ladder) {
    std::vector<std::size_t> out;
    const std::size_t count = std::min<std::size_t>(ladder.n.size(), 4);
    for (std::size_t k = 0; k < count; ++k) out.push_back(count == 1 ? 0 : k * (ladder.n.size() - 1) / (count - 1));
    return out;
}

/// An arm's sample counts in the chart.
struct Line {
    std::vector<Point> points;
    Words name;
    Colour ink;
};

Line line_of(const Data& data, const std::string& arm, const LogPlot& plot) {
    return {points_of(ladder_of(data, arm), plot), Words(data.arm(arm)), data.ink(arm)};
}

/// Draws the line of an earlier shot.
void draw_dim(Frame& f, const Line& earlier_line) {
    const double in = f.ease(0.6, 1.2);
    f.polyline(earlier_line.points, earlier_line.ink, 4, 0.55 * in);
    for (const Point& p : earlier_line.points) f.dot(p, 7, earlier_line.ink, 0.55 * in);
    f.text({earlier_line.points.back().x - 250, earlier_line.points.back().y - 96, 270, 44}, earlier_line.name,
        with(with(label_text, earlier_line.ink), Align::right), in);
}

}  // namespace

const Ladder& ladder_of(const Data& data, const std::string& arm) {
    const auto match = std::ranges::find_if(data.metrics.ladders,
        [&](const Ladder& l) { return l.arm == arm && l.region == data.cast.highlight && l.s == data.cast.s; });
    ensure(match != data.metrics.ladders.end(), "both arms of the film have a ladder");
    return *match;
}

Words slope_words(const Ladder& l) {
    const std::string source = "ladder of " + l.arm + " in " + l.region;
    Words words("slope ", figure(l.slope, 3, source));
    if (l.heavy) return words << ", heavy tail: no interval";
    if (std::isfinite(l.low) && std::isfinite(l.high))
        words << " (" << figure(l.low, 3, source) << " to " << figure(l.high, 3, source) << ")";
    return words;
}

Shot ladder_shot(const Data& data, const LadderShotText& text) {
    const Ladder& ladder = ladder_of(data, text.arm);
    const LogPlot plot = plot_of(data);
    const Closeup crop = close_up(data, data.box(data.cast.highlight), {0, 0, 380, 310}, 1.35);
    std::vector<Block> blocks;
    std::vector<Words> labels;
    for (const std::size_t k : shown_of(ladder)) {
        const RunKey key = data.key(text.arm, ladder.n[k]);
        blocks.push_back(photograph_of(data, plates::view(data.film(key)), crop.box));
        labels.push_back(Words("N\u00a0=\u00a0", data.n_of(key), ", off by ", data.rmse(key, data.cast.highlight)));
    }
    const Line line = line_of(data, text.arm, plot);
    std::optional<Line> earlier_line;
    if (!text.dimmed_arm.empty()) earlier_line = line_of(data, text.dimmed_arm, plot);
    const Words slope = slope_words(ladder);
    std::vector<std::uint64_t> ticks = ladder.n;

    Shot shot;
    shot.kind = Kind::photograph;
    const double line_start = first + interval * double(blocks.size());
    shot.cues = {{0.5, text.opening}};
    for (std::size_t k = 0; k < text.closing.size(); ++k)
        shot.cues.push_back({line_start + 5.4 * double(k), text.closing[k]});
    shot.seconds = line_start + 5.4 * double(text.closing.size());
    shot.still = shot.seconds - 0.8;
    shot.draw = [=](Frame& f) {
        plot.axes(f, ticks, Words("samples a pixel, N"), Words("RMSE in the highlight"), f.ease(0.4, 1));
        if (earlier_line && !earlier_line->points.empty()) draw_dim(f, *earlier_line);
        for (std::size_t k = 0; k < blocks.size(); ++k) {
            const double time = first + interval * double(k), in = f.ease(time, time + 0.5);
            const double x = 90 + 430.0 * double(k % 2), y = 122 + 388.0 * double(k / 2);
            show(f, blocks[k], crop.times, {x, y, 380, 310}, in);
            f.text({x, y + 318, 380, 48}, labels[k], with(body_text, Vertical::middle), in);
        }
        const int n = f.steps(first, line_start, static_cast<int>(line.points.size()));
        f.polyline(begun(line.points, f.ease(line_start, line_start + 1.5)), line.ink, 5);
        for (std::size_t k = 0; k < line.points.size(); ++k) {
            const double time = first + interval * double(blocks.size()) * double(k) / double(line.points.size());
            f.dot(line.points[k], 11, line.ink, f.ease(time + 0.4, time + 0.9));
        }
        if (n == 0 && line.points.empty()) return;
        f.text({plot.plot.x + 30, plot.plot.bottom() - 116, plot.plot.w - 40, 48}, line.name,
            with(label_text, line.ink), f.ease(first, first + 0.6));
        f.text({plot.plot.x + 30, plot.plot.bottom() - 66, plot.plot.w - 40, 48}, slope, with_px(label_text, 34),
            f.ease(line_start + 1.2, line_start + 1.8));
    };
    return shot;
}

}  // namespace crescent::explainer
