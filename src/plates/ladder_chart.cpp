#include "plates/ladder_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "math/functions.h"
#include "plates/words.h"

namespace crescent::plates {

namespace {

struct Axes {
    Rect plot;
    double x0 = 0, x1 = 1, y0 = 0, y1 = 1;  // natural logarithms
    double x(double n) const { return plot.x + plot.w * (math::log(n) - x0) / (x1 - x0); }
    double y(double v) const { return plot.bottom() - plot.h * (math::log(v) - y0) / (y1 - y0); }
};

// Those of the arms that the plate shows; of all arms where it names none.
std::vector<const Ladder*> ladders_of(const Sheet& sheet, const std::string& region) {
    const std::vector<RunKey> shown = keys_of(sheet.plan, sheet.experiment());
    std::vector<const Ladder*> list;
    for (const Ladder& l : sheet.in.metrics.ladders) {
        const bool here =
            shown.empty() || std::any_of(shown.begin(), shown.end(), [&](const RunKey& k) { return k.arm == l.arm; });
        if (here && l.region == region && l.s == sheet.experiment().s() && l.n.size() > 1) list.push_back(&l);
    }
    return list;
}

bool drawable(double v) { return std::isfinite(v) && v > 0; }

Axes scale(const std::vector<const Ladder*>& ladders, const Rect& plot) {
    double n0 = 1e300, n1 = 0, v0 = 1e300, v1 = 0;
    for (const Ladder* l : ladders) {
        for (std::size_t i = 0; i < l->n.size(); ++i) {
            n0 = std::min(n0, double(l->n[i])), n1 = std::max(n1, double(l->n[i]));
            if (!drawable(l->rmse[i])) continue;
            v0 = std::min(v0, l->rmse[i]), v1 = std::max(v1, l->rmse[i]);
        }
    }
    if (v1 <= 0) v0 = v1 = 1;
    Axes a{plot, math::log(n0) - 0.15, math::log(n1) + 0.15, math::log(v0 / 1.4), math::log(v1 * 1.4)};
    return a;
}

void draw_axes(Sheet& sheet, const Axes& a, const std::vector<const Ladder*>& ladders) {
    Canvas& c = sheet.canvas;
    std::set<std::uint64_t> rungs;
    for (const Ladder* l : ladders) rungs.insert(l->n.begin(), l->n.end());
    double last = -1e9;
    for (std::uint64_t n : rungs) {
        double x = a.x(double(n));
        c.line(x, a.plot.bottom(), x, a.plot.bottom() + 5, muted, 1.5);
        if (x - last < 44) continue;
        c.text({x - 40, a.plot.bottom() + 6, 80, 20}, count(n), with(with_px(small_text, 16), Align::centre));
        last = x;
    }
    int decades = static_cast<int>(std::ceil((a.y1 - a.y0) / math::log(10.0)));
    for (int p = static_cast<int>(std::floor(a.y0 / math::log(10.0))); p <= std::ceil(a.y1 / math::log(10.0)); ++p) {
        for (int m : {1, 2, 5}) {
            double v = m * math::pow(10.0, p);
            if ((m != 1 && decades > 2) || math::log(v) < a.y0 || math::log(v) > a.y1) continue;
            c.line(a.plot.x, a.y(v), a.plot.right(), a.y(v), rule, 1);
            c.text({a.plot.x - 66, a.y(v) - 11, 58, 22}, number(v, 3),
                with(with(with_px(small_text, 16), Align::right), Vertical::middle));
        }
    }
    c.line(a.plot.x, a.plot.bottom(), a.plot.right(), a.plot.bottom(), muted, 1.5);
}

std::string signed_number(double v) { return fmt::format("{}{:.2f}", v < 0 ? "−" : "", std::abs(v)); }

std::string slope_text(const Ladder& l, const Experiment& e) {
    std::string name = arm_name(l.arm, e);
    if (!std::isfinite(l.slope)) return name;
    return l.heavy ? name + ": heavy tail" : fmt::format("{}: N<sup> {}</sup>", name, signed_number(l.slope));
}

// Where the names stand: at the ends of their lines, pushed apart to `pitch` and kept beside the plot.
std::vector<double> name_places(const Axes& a, const std::vector<const Ladder*>& ladders, double pitch) {
    std::vector<std::pair<double, std::size_t>> ends;
    for (std::size_t i = 0; i < ladders.size(); ++i) {
        double v = ladders[i]->rmse.back();
        ends.push_back({drawable(v) ? a.y(v) : a.plot.y, i});
    }
    std::sort(ends.begin(), ends.end());
    double floor = a.plot.y - 30;
    for (auto& e : ends) e.first = floor = std::max(e.first, floor + pitch);
    double ceiling = a.plot.bottom() + 12 + pitch / 2;
    for (auto e = ends.rbegin(); e != ends.rend(); ++e) e->first = ceiling = std::min(e->first, ceiling - pitch);
    std::vector<double> y(ladders.size());
    for (const auto& [place, i] : ends) y[i] = place;
    return y;
}

// Each name with its slope, and under it the slope's interval where there is room for two lines.
void draw_names(Sheet& sheet, const Axes& a, const std::vector<const Ladder*>& ladders) {
    double pitch = std::min(44.0, (a.plot.h + 30) / double(ladders.size()));
    bool two = pitch >= 40;
    double h = two ? 22 : std::min(24.0, pitch);
    std::vector<double> places = name_places(a, ladders, two ? 44 : std::min(pitch, 24.0));
    for (std::size_t i = 0; i < ladders.size(); ++i) {
        const Ladder& l = *ladders[i];
        Rect line{a.plot.right() + 10, places[i] - h / 2, 178, h};
        Text how = with(with(with_px(body_text, 17), arm_colour(l.arm, sheet.experiment())), Vertical::middle);
        how.least = 9;
        sheet.canvas.text(line, slope_text(l, sheet.experiment()), how);
        if (!two || l.heavy || !std::isfinite(l.low) || !std::isfinite(l.high)) continue;
        line.y += h - 2, line.h = 20;
        sheet.canvas.text(line, signed_number(l.low) + " to " + signed_number(l.high), small_text);
    }
}

}  // namespace

void draw_ladder_chart(Sheet& sheet, const Rect& slot, const std::string& region) {
    std::vector<const Ladder*> ladders = ladders_of(sheet, region);
    if (ladders.empty()) return;
    Axes a = scale(ladders, {slot.x + 70, slot.y + 34, slot.w - 70 - 188, slot.h - 34 - 28});
    sheet.canvas.text({slot.x, slot.y, slot.w - 188, 26}, "RMSE<sub>" + escaped(region) + "</sub> against N",
        with(body_text, Weight::semibold));
    draw_axes(sheet, a, ladders);
    for (const Ladder* l : ladders) {
        std::vector<Canvas::Point> path;
        for (std::size_t k = 0; k < l->n.size(); ++k) {
            if (drawable(l->rmse[k])) path.push_back({a.x(double(l->n[k])), a.y(l->rmse[k])});
        }
        Colour ink = arm_colour(l->arm, sheet.experiment());
        sheet.canvas.polyline(path, ink, 2.5);
        for (const Canvas::Point& p : path) sheet.canvas.dot(p.x, p.y, 4, ink);
    }
    draw_names(sheet, a, ladders);
}

}  // namespace crescent::plates
