#include "plates/polar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plates/sheet.h"

namespace crescent::plates {

namespace {

constexpr double degree = std::numbers::pi / 180;

struct Frame {
    double x, y, radius;
    Canvas::Point at(double angle, double fraction) const {
        return {x + radius * fraction * std::sin(angle), y - radius * fraction * std::cos(angle)};
    }
};

void draw_axes(Canvas& c, const Frame& f, double top) {
    for (int a = -90; a <= 90; a += 30) {
        Canvas::Point rim = f.at(a * degree, 1);
        c.line(f.x, f.y, rim.x, rim.y, rule, 1);
        if (std::abs(a) == 90) continue;
        Canvas::Point p = f.at(a * degree, 1 + 14 / f.radius);
        std::string text = a == 0 ? "n" : fmt::format("{}{}°", a < 0 ? "−" : "", std::abs(a));
        double shift = 22 * std::sin(a * degree);
        c.text({p.x - 24 + shift, p.y - 11, 48, 22}, text,
               with(with(with_px(small_text, 16), Align::centre), Vertical::middle));
    }
    double step = round_step(top, 3);
    Text how = with(with_px(small_text, 16), Align::centre);
    for (int k = 0; k * step <= top * 1.001; ++k) {
        double fraction = k * step / top;
        std::vector<Canvas::Point> arc;
        for (int a = -90; a <= 90; a += 2) arc.push_back(f.at(a * degree, fraction));
        c.polyline(arc, rule, 1);
        double x = f.x + f.radius * fraction;
        c.line(x, f.y, x, f.y + 5, muted, 1.5);
        c.text({x - 28, f.y + 7, 56, 20}, number(k * step, 3), how);
    }
    c.line(f.x - f.radius, f.y, f.x + f.radius, f.y, muted, 1.5);
    c.text({f.x - f.radius, f.y + 7, f.radius - 30, 20}, "p, 1/sr", with_px(small_text, 16));
}

void draw_curve(Canvas& c, const Frame& f, const PolarCurve& curve, double top) {
    std::vector<Canvas::Point> path;
    for (int k = -360; k <= 360; ++k) {
        double a = k * 0.25 * degree;
        path.push_back(f.at(a, std::min(curve.value(a) / top, 1.0)));
    }
    if (curve.filled) {
        Colour wash = curve.ink;
        wash.a = 0.25;
        c.polygon(path, wash);
    }
    c.polyline(path, curve.ink, curve.filled ? 2.5 : 1.75);
}

}  // namespace

void draw_polar(Canvas& canvas, const PolarPlot& plot) {
    double radius = std::min(plot.slot.w / 2 - 56, plot.slot.h - 30 - 24);
    if (radius < 20) return;
    // A circle short of the peak would cut the curve; the outermost ring is the peak itself.
    Frame f{plot.slot.x + plot.slot.w / 2, plot.slot.bottom() - 30, radius};
    draw_axes(canvas, f, plot.top);
    std::vector<Canvas::Point> arc;
    for (int a = -90; a <= 90; a += 2) arc.push_back(f.at(a * degree, 1));
    canvas.polyline(arc, rule, 1);
    Canvas::Point r = f.at(plot.tilt, 1);
    canvas.line(f.x, f.y, r.x, r.y, muted, 1.5, 5);
    for (const PolarCurve& curve : plot.curves) draw_curve(canvas, f, curve, plot.top);
}

}  // namespace crescent::plates
