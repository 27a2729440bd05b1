// Rings at a round step, 1, 2, 2.5, 3, 4 or 5 times a power of ten, 44 pixels apart or more; rays every 30 degrees from
// n. A curve is a polyline with a point every quarter of a degree. Densities in 1/sr.
#include "plates/polar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/functions.h"
#include "pages/axis.h"
#include "plates/sheet.h"

namespace crescent::plates {

namespace {

constexpr double degree = std::numbers::pi / 180;

struct Frame {
    double x, y, radius;
    Canvas::Point at(double angle, double fraction) const {
        return {x + radius * fraction * math::sin(angle), y - radius * fraction * math::cos(angle)};
    }
};

// The rim names the angles: n at 0, and where they fall on a ray, R and the direction it mirrors.
std::string angle_name(int deg, int tilt_deg, bool roomy) {
    if (deg == 0) return "n";
    std::string text = fmt::format("{}{}°", deg < 0 ? "−" : "", std::abs(deg));
    if (!roomy) return text;
    if (deg == tilt_deg) return "R, " + text;
    if (deg == -tilt_deg) return "ω<sub>o</sub>, " + text;
    return text;
}

void draw_rays(Canvas& c, const Frame& f, double tilt) {
    for (int a = -90; a <= 90; a += 30) {
        Canvas::Point rim = f.at(a * degree, 1);
        c.line(f.x, f.y, rim.x, rim.y, rule, 1);
        if (std::abs(a) == 90) continue;
        Canvas::Point p = f.at(a * degree, 1 + 8 / f.radius);
        Text how = with(with(with_px(small_text, 16), Vertical::middle),
            a < 0       ? Align::right
                : a > 0 ? Align::left
                        : Align::centre);
        double x = a < 0 ? p.x - 80 : a > 0 ? p.x : p.x - 40;
        std::string name = angle_name(a, int(std::lround(tilt / degree)), f.radius >= 110);
        c.text({x, p.y - 11 - 6 * math::cos(a * degree), 80, 22}, name, how);
    }
    Canvas::Point r = f.at(tilt, 1);
    c.line(f.x, f.y, r.x, r.y, muted, 1.5, 5);
}

void draw_circles(Canvas& c, const Frame& f, double step, int rings) {
    Text how = with(with_px(small_text, 16), Align::centre);
    for (int k = 0; k <= rings; ++k) {
        double fraction = double(k) / rings;
        std::vector<Canvas::Point> arc;
        for (int a = -90; a <= 90; a += 2) arc.push_back(f.at(a * degree, fraction));
        if (k > 0) c.polyline(arc, rule, 1);
        double x = f.x + f.radius * fraction;
        c.line(x, f.y, x, f.y + 5, muted, 1.5);
        c.text({x - 28, f.y + 7, 56, 20}, number(k * step, 3), how);
    }
    c.line(f.x - f.radius, f.y, f.x + f.radius, f.y, muted, 1.5);
    if (f.radius >= 100) c.text({f.x - f.radius, f.y + 7, f.radius - 30, 20}, "p, 1/sr", with_px(small_text, 16));
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
    c.polyline(path, curve.ink, curve.filled ? 2.5 : 2);
}

void draw_legend(Canvas& c, const PolarPlot& plot) {
    Rect row{plot.slot.right() - plot.legend_w + 24, plot.slot.y + 14, plot.legend_w - 24, 22};
    for (const PolarCurve& curve : plot.curves) {
        c.line(row.x, row.y + 11, row.x + 18, row.y + 11, curve.ink, curve.filled ? 3 : 2);
        c.text({row.x + 26, row.y, row.w - 26, row.h}, curve.name, with(with_px(small_text, 16), Vertical::middle));
        row.y += 25;
    }
}

}  // namespace

void draw_polar(Canvas& canvas, const PolarPlot& plot) {
    double w = plot.slot.w - plot.legend_w;
    double radius = std::min(w / 2 - 40, plot.slot.h - 30 - 28);
    if (radius < 20) return;
    double step =
        round_up(plot.peak / std::max(1, static_cast<int>(radius / 44)), {1, 2, 2.5, 3, 4, 5});  // a label needs 44 px
    int rings = static_cast<int>(std::ceil(plot.peak / step - 1e-6));
    Frame f{std::floor(plot.slot.x + w / 2), plot.slot.bottom() - 30, radius};
    draw_circles(canvas, f, step, rings);
    draw_rays(canvas, f, plot.tilt);
    for (const PolarCurve& curve : plot.curves) draw_curve(canvas, f, curve, step * rings);
    if (plot.legend_w > 0) draw_legend(canvas, plot);
}

}  // namespace crescent::plates
