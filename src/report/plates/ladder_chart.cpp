// Logarithmic axes around all values that can be drawn, a factor of 1.16 wider in N and of 1.4 in the value on each
// side. Names are at the ends of curves, moved apart. Lengths in pixels.
#include "report/plates/ladder_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "output/charts.h"
#include "report/plates/sheet.h"

namespace crescent::plates {

namespace {

struct Axes {
    Rect plot;
    Axis across, up;
    double x(double n) const { return plot.x + plot.w * across.share(n); }
    double y(double v) const { return plot.bottom() - plot.h * up.share(v); }
};

Axes axes_of(const std::vector<LadderCurve>& curves, const Rect& plot) {
    std::vector<double> sample_counts, values;
    for (const LadderCurve& l : curves) {
        sample_counts.insert(sample_counts.end(), l.n.begin(), l.n.end());
        values.insert(values.end(), l.value.begin(), l.value.end());
        for (const auto& [low, high] : l.interval) values.insert(values.end(), {low, high});
    }
    return {plot, log_axis("N", sample_counts, 1.16), log_axis("", values, 1.4)};
}

std::string sample_count_label(double n) {
    return n == std::floor(n) ? count(static_cast<std::uint64_t>(n)) : number(n, 3);
}

void draw_axes(Canvas& c, const Axes& a, const std::vector<LadderCurve>& curves) {
    std::set<double> sample_counts;
    for (const LadderCurve& l : curves) sample_counts.insert(l.n.begin(), l.n.end());
    double last = -1e9;
    for (const double n : sample_counts) {
        double x = a.x(n);
        c.line(x, a.plot.bottom(), x, a.plot.bottom() + 5, muted, 1.5);
        if (x - last < 44) continue;
        c.text(
            {x - 40, a.plot.bottom() + 6, 80, 20}, sample_count_label(n), with(with_px(small_text, 16), Align::centre));
        last = x;
    }
    for (const double v : a.up.ticks) {
        c.line(a.plot.x, a.y(v), a.plot.right(), a.y(v), rule, 1);
        c.text({a.plot.x - 66, a.y(v) - 11, 58, 22}, number(v, 3),
            with(with(with_px(small_text, 16), Align::right), Vertical::middle));
    }
    c.line(a.plot.x, a.plot.bottom(), a.plot.right(), a.plot.bottom(), muted, 1.5);
}

std::string signed_number(double v) { return fmt::format("{}{:.2f}", v <= -0.005 ? "−" : "", std::abs(v)); }

std::string slope_text(const LadderCurve& l) {
    if (!std::isfinite(l.slope)) return l.name;
    return l.heavy ? l.name + ": heavy tail" : fmt::format("{}: N<sup> {}</sup>", l.name, signed_number(l.slope));
}

// Places the names at the ends of their lines, `pitch` apart and next to the plot.
std::vector<double> name_places(const Axes& a, const std::vector<LadderCurve>& curves, double pitch) {
    std::vector<double> ends;
    for (const LadderCurve& l : curves) ends.push_back(a.up.can_hold(l.value.back()) ? a.y(l.value.back()) : a.plot.y);
    return moved_apart(ends, pitch, a.plot.y - 30 + pitch, a.plot.bottom() + 12 - pitch / 2);
}

// Draws each name with its slope, and under it the slope's interval if there is room for two lines.
void draw_names(Canvas& c, const Axes& a, const std::vector<LadderCurve>& curves) {
    double pitch = std::min(44.0, (a.plot.h + 30) / double(curves.size()));
    bool two = pitch >= 40;
    double h = two ? 22 : std::min(24.0, pitch);
    std::vector<double> places = name_places(a, curves, two ? 44 : std::min(pitch, 24.0));
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const LadderCurve& l = curves[i];
        Rect line{a.plot.right() + 10, places[i] - h / 2, 178, h};
        Text how = with(with(with_px(body_text, 17), l.ink), Vertical::middle);
        how.least = 9;
        c.text(line, slope_text(l), how);
        if (!two || l.heavy || !std::isfinite(l.low) || !std::isfinite(l.high)) continue;
        line.y += h - 2, line.h = 20;
        c.text(line, signed_number(l.low) + " to " + signed_number(l.high), small_text);
    }
}

void draw_interval(Canvas& c, const Axes& a, double n, const std::pair<double, double>& ends, const Colour& ink) {
    if (!a.up.can_hold(ends.first) || !a.up.can_hold(ends.second)) return;
    const double x = a.x(n), low = a.y(ends.first), high = a.y(ends.second);
    c.line(x, low, x, high, ink, 1.5);
    for (const double y : {low, high}) c.line(x - 4, y, x + 4, y, ink, 1.5);
}

}  // namespace

std::vector<LadderCurve> ladder_curves(const Sheet& sheet, const std::string& region) {
    const Experiment& e = sheet.experiment();
    const std::vector<RunKey> shown = keys_of(sheet.plan, e);
    std::vector<LadderCurve> out;
    for (const Ladder& l : sheet.in.metrics.ladders) {
        const bool here =
            shown.empty() || std::any_of(shown.begin(), shown.end(), [&](const RunKey& k) { return k.arm == l.arm; });
        if (!here || l.region != region || l.s != e.s() || l.n.size() < 2) continue;
        out.push_back({arm_name(l.arm, e), arm_colour(l.arm, e), {l.n.begin(), l.n.end()}, l.rmse, {}, l.slope, l.low,
            l.high, l.heavy});
    }
    return out;
}

void draw_ladder_chart(Canvas& c, const Rect& slot, const std::string& title, const std::vector<LadderCurve>& curves) {
    if (curves.empty()) return;
    const Axes a = axes_of(curves, {slot.x + 70, slot.y + 34, slot.w - 70 - 188, slot.h - 34 - 28});
    c.text({slot.x, slot.y, slot.w - 188, 26}, title, with(body_text, Weight::semibold));
    draw_axes(c, a, curves);
    for (const LadderCurve& l : curves) {
        std::vector<Canvas::Point> path;
        for (std::size_t k = 0; k < l.n.size(); ++k) {
            if (a.up.can_hold(l.value[k])) path.push_back({a.x(l.n[k]), a.y(l.value[k])});
            if (k < l.interval.size()) draw_interval(c, a, l.n[k], l.interval[k], l.ink);
        }
        c.polyline(path, l.ink, 2.5);
        for (const Canvas::Point& p : path) c.dot(p.x, p.y, 4, l.ink);
    }
    draw_names(c, a, curves);
}

}  // namespace crescent::plates
