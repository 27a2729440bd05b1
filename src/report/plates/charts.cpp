// Rings at a round step, 1, 2, 2.5, 3, 4 or 5 times a power of ten, at least 44 pixels apart; rays every 30 degrees
// from n. A curve is a polyline with a point every quarter of a degree. Densities in 1/sr.
#include "report/plates/charts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <numbers>
#include <set>

#include "base/vec.h"
#include "math/functions.h"
#include "output/charts.h"
#include "render/pixel.h"
#include "report/plates/sheet.h"
#include "samplers/all.h"
#include "scene/scene.h"

namespace crescent::plates {

double DensityScale::share(double p) const {
    if (decades == 0) return std::min(p / top, 1.0);
    return p > 0 ? std::clamp(1 + math::log10(p / top) / decades, 0.0, 1.0) : 0;
}

namespace {

struct Frame {
    double x, y, radius;
    Canvas::Point at(double angle, double fraction) const {
        return {x + radius * fraction * math::sin(angle), y - radius * fraction * math::cos(angle)};
    }
};

// The edge shows the angles: n at 0, and, if they are on a ray, R and the direction it mirrors.
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
        Canvas::Point rim = f.at(a * radians_per_degree, 1);
        c.line(f.x, f.y, rim.x, rim.y, rule, 1);
        if (std::abs(a) == 90) continue;
        Canvas::Point p = f.at(a * radians_per_degree, 1 + 8 / f.radius);
        Text style = with(with(with_px(small_text, 16), Vertical::middle),
            a < 0       ? Align::right
                : a > 0 ? Align::left
                        : Align::centre);
        double x = a < 0 ? p.x - 80 : a > 0 ? p.x : p.x - 40;
        std::string name = angle_name(a, int(std::lround(tilt / radians_per_degree)), f.radius >= 110);
        c.text({x, p.y - 11 - 6 * math::cos(a * radians_per_degree), 80, 22}, name, style);
    }
    Canvas::Point r = f.at(tilt, 1);
    c.line(f.x, f.y, r.x, r.y, muted, 1.5, 5);
}

constexpr double label_room = 44;  // pixels between two labels

/// The circles of a polar plot: the numbers at them, from the centre; "": there is no room for one.
std::vector<std::string> ring_labels(const DensityScale& scale, double step, double radius) {
    std::vector<std::string> out;
    if (scale.decades == 0) {
        for (int k = 0; k * step < scale.top * (1 + 1e-6); ++k) out.push_back(number(k * step, 3));
        return out;
    }
    const int stride = static_cast<int>(std::ceil(label_room * scale.decades / radius));
    for (int k = -scale.decades; k <= 0; ++k)
        out.push_back(k % stride == 0 ? number(scale.top * math::pow(10.0, k), 3) : "");
    return out;
}

void draw_circles(Canvas& c, const Frame& f, const std::vector<std::string>& labels) {
    const int rings = static_cast<int>(labels.size()) - 1;
    Text style = with(with_px(small_text, 16), Align::centre);
    for (int k = 0; k <= rings; ++k) {
        double fraction = double(k) / rings;
        std::vector<Canvas::Point> arc;
        for (int a = -90; a <= 90; a += 2) arc.push_back(f.at(a * radians_per_degree, fraction));
        if (k > 0) c.polyline(arc, rule, 1);
        double x = f.x + f.radius * fraction;
        c.line(x, f.y, x, f.y + 5, muted, 1.5);
        c.text({x - 28, f.y + 7, 56, 20}, labels[static_cast<std::size_t>(k)], style);
    }
    c.line(f.x - f.radius, f.y, f.x + f.radius, f.y, muted, 1.5);
    if (f.radius >= 100) c.text({f.x - f.radius, f.y + 7, f.radius - 30, 20}, "p, 1/sr", with_px(small_text, 16));
}

void draw_curve(Canvas& c, const Frame& f, const PolarCurve& curve, const DensityScale& scale) {
    std::vector<Canvas::Point> path;
    for (int k = -360; k <= 360; ++k) {
        double a = k * 0.25 * radians_per_degree;
        path.push_back(f.at(a, scale.share(curve.value(a))));
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
    DensityScale scale = plot.scale;
    double step = 0;
    if (scale.decades == 0) {
        step = round_up(scale.top / std::max(1, static_cast<int>(radius / label_room)), {1, 2, 2.5, 3, 4, 5});
        scale.top = step * std::ceil(scale.top / step - 1e-6);
    } else {
        scale.top = math::pow(10.0, std::ceil(math::log10(scale.top) - 1e-6));
    }
    Frame f{std::floor(plot.slot.x + w / 2), plot.slot.bottom() - 30, radius};
    draw_circles(canvas, f, ring_labels(scale, step, radius));
    draw_rays(canvas, f, plot.tilt);
    for (const PolarCurve& curve : plot.curves) draw_curve(canvas, f, curve, scale);
    if (plot.legend_w > 0) draw_legend(canvas, plot);
}

// ---- The density is evaluated in double at a point with the material of surface_of_densities(); its peak is the
// largest of 1801 angles. An arm that aims at lights is evaluated at a pixel, selected among a few thousand, whose R is
// nearest to the tilt and whose light is nearest to R's plane; its peak is that of 1024 draws.

std::optional<std::size_t> surface_of_densities(const Experiment& e) {
    if (const auto surface = e.surface_of_s()) return surface;
    for (std::size_t k = 0; k < e.surface_count(); ++k)
        if (e.material(k).rho_s > 0) return k;
    return {};
}

namespace {

/// Returns a point of the surface for which the density is shown.
ShadingPoint<double> point_of(const Experiment& e, double s, double tilt) {
    const auto surface_index = surface_of_densities(e);
    Material material = surface_index ? e.material(*surface_index) : Material{};
    material.s = s;
    const Surface surface = surface_of(material, s);
    ShadingPoint<double> shading_point{};
    shading_point.wo = {-math::sin(tilt), 0, math::cos(tilt)};
    shading_point.s = surface.s;
    shading_point.alpha = surface.alpha;
    shading_point.diffuse = luminance(surface.rho_d);
    shading_point.lobe = surface.rho_s;
    if (surface.rho_s > 0) shading_point.lobe_kind = material.brdf;
    return shading_point;
}

// A sampler without a single density (several techniques, each with its own) gives 0.
template <class Arm> constexpr bool has_pdf = requires(const Arm a, Vec3d w) { a.pdf(w, w); };

/// Returns the direction `angle` radians from n, in the plane of incidence.
Vec3d in_incidence(double angle) { return {math::sin(angle), 0, math::cos(angle)}; }

/// Returns directions from a pixel to light that a sampler aims at: to each light that faces the pixel, and of its
/// first draws to the sky or to emitting triangles the densest.
std::vector<Vec3d> directions_to_light(const OpenPixel& pixel, const SamplerInfo& sampler) {
    std::vector<Vec3d> out;
    if (sampler.reaches.lights)
        for (const PixelLight& light : pixel.lights())
            if (light.faces) out.push_back(light.towards);
    if (!sampler.reaches.sky && !sampler.reaches.triangles) return out;
    constexpr std::uint64_t draws = 32;
    const std::vector<PixelSample> samples = pixel.samples(sampler.name, draws, 1);
    const auto density = [](const PixelSample& s) { return s.meets_surroundings && s.x > 0 ? s.pdf : 0.0f; };
    const auto densest = std::ranges::max_element(samples, {}, density);
    if (densest != samples.end() && density(*densest) > 0) out.push_back(widen(densest->wi));
    return out;
}

/// Returns how far a pixel is from one with R at `tilt` and light that the sampler aims at in the plane of incidence,
/// in radians; infinite if no such light reaches it or R is n.
double off_the_plane(const OpenPixel& pixel, const SamplerInfo& sampler, double tilt) {
    const Vec3d r = pixel.mirror();
    const double radius = math::hypot(r.x, r.y);
    double smallest = std::numeric_limits<double>::infinity();
    if (!(radius > 0.01)) return smallest;
    for (const Vec3d& towards : directions_to_light(pixel, sampler))
        if (towards.z > 0.05)
            smallest = std::min(smallest,
                std::fabs(math::atan2(radius, r.z) - tilt) +
                    std::fabs(math::asin((r.x * towards.y - r.y * towards.x) / radius)));
    return smallest;
}

/// Selects among a few thousand pixels that see the shape whose exponent is the experiment's, or any shape if there is
/// none.
std::shared_ptr<const OpenPixel> lit_pixel(const Experiment& e, const SamplerInfo& sampler, double s, double tilt) {
    const Scene scene = Scene(e).with_s(s);
    const auto surface = e.surface_of_s();
    const std::ptrdiff_t shape = surface ? static_cast<std::ptrdiff_t>(*surface) : -1;
    const int step =
        std::max(1, static_cast<int>(std::sqrt(e.image.width * static_cast<double>(e.image.height) / 4e3)));
    std::shared_ptr<const OpenPixel> best;
    double smallest = std::numeric_limits<double>::infinity();
    for (int j = 0; j < e.image.height; j += step)
        for (int i = 0; i < e.image.width; i += step) {
            const auto hit = scene.primary(i, j);
            if (!hit || (shape >= 0 && hit->shape != shape)) continue;
            auto pixel = std::make_shared<const OpenPixel>(scene, i, j);
            const double distance = off_the_plane(*pixel, sampler, tilt);
            if (distance < smallest) {
                smallest = distance;
                best = std::move(pixel);
            }
        }
    return best;
}

/// A density evaluated for one direction after the other.
auto one_by_one(std::function<double(const Vec3d&)> pdf) {
    return [pdf = std::move(pdf)](std::span<const Vec3d> wi, std::span<double> out) {
        for (std::size_t i = 0; i < wi.size(); ++i) out[i] = pdf(wi[i]);
    };
}

bool aims_at_lights_alone(const std::string& sampler) {
    const SamplerInfo* info = find_arm_info(sampler);
    return info && !info->combines && !info->misses.empty();
}

}  // namespace

Density::Density(const Experiment& e, const std::string& sampler, double s, double tilt)
    : ask_(one_by_one([](const Vec3d&) { return 0.0; })), tilt_(tilt) {
    if (aims_at_lights_alone(sampler)) {
        query_at_a_pixel(e, sampler, s);
        return;
    }
    ShadingPoint<double> shading_point = point_of(e, s, tilt);
    for_each_sampler(Samplers{}, [&]<template <class> class A>() {
        if constexpr (has_pdf<A<double>>) {
            if (sampler != A<double>::name) return;
            ask_ = one_by_one([arm = A<double>(shading_point), wo = shading_point.wo](const Vec3d& wi) {
                double p = arm.pdf(wo, wi).v;
                return std::isfinite(p) ? p : 0.0;
            });
        }
    });
    find_peak();
}

Density::Density(const Experiment& e, const SamplerAdapter& external, double s, double tilt) : tilt_(tilt) {
    const ShadingPoint<double> shading_point = point_of(e, s, tilt);
    const SamplerDeclaration declaration = external.declaration();
    ask_ = [&external, longest = declaration.batch_rows, wo = shading_point.wo,
               surface = SurfaceParameters{shading_point.s, shading_point.alpha, shading_point.diffuse,
                   shading_point.lobe}](std::span<const Vec3d> wi, std::span<double> out) {
        std::vector<Pair> pairs;
        for (const Vec3d w : wi) pairs.push_back({wo, w});
        for (std::size_t first = 0; first < wi.size(); first += longest) {
            const std::size_t rows = std::min(wi.size() - first, longest);
            const SurfaceRun run{wo, surface, rows, {surface.diffuse, surface.diffuse, surface.diffuse}};
            const SceneRows scene{.runs = {&run, 1}};
            external.evaluate(
                {.kind = SamplerQuery::Kind::pdf, .pairs = std::span(pairs).subspan(first, rows), .scene = &scene},
                {.values = out.subspan(first, rows)});
        }
        for (double& p : out) p = p > 0 && std::isfinite(p) ? p : 0.0;
    };
    if (!declaration.traits.has_pdf || declaration.uses_lights()) ask_ = one_by_one([](const Vec3d&) { return 0.0; });
    find_peak();
}

void Density::find_peak() {
    std::vector<Vec3d> plane;
    for (int i = -900; i <= 900; ++i) plane.push_back(in_incidence(i * pi / 1800));
    for (const double p : at(plane)) peak_ = std::max(peak_, p);
}

void Density::query_at_a_pixel(const Experiment& e, const std::string& sampler, double s) {
    const std::shared_ptr<const OpenPixel> pixel = lit_pixel(e, *find_arm_info(sampler), s, tilt_);
    if (!pixel) return;
    const Vec3d r = pixel->mirror();
    const double radius = math::hypot(r.x, r.y), x = r.x / radius, y = r.y / radius;  // from n towards R
    tilt_ = math::atan2(radius, r.z);
    where_ = fmt::format("pixel ({}, {})", pixel->i(), pixel->j());
    ask_ = one_by_one([=](const Vec3d& wi) {
        const double p = pixel->pdf(sampler, {wi.x * x - wi.y * y, wi.x * y + wi.y * x, wi.z});
        return wi.z > 0 && std::isfinite(p) ? p : 0.0;
    });
    for (const PixelSample& sample : pixel->samples(sampler, 1024, 1))
        if (sample.cos > 0) peak_ = std::max(peak_, static_cast<double>(sample.pdf));
}

std::vector<double> Density::at(std::span<const Vec3d> wi) const {
    std::vector<double> out(wi.size());
    ask_(wi, out);
    return out;
}

DensityScale Density::scale() const {
    DensityScale out{.top = peak_};
    if (where_.empty()) return out;
    constexpr int rings = 32, spokes = 64;
    std::vector<Vec3d> directions;  // of equal solid angle
    for (int k = 0; k < rings; ++k)
        for (int m = 0; m < spokes; ++m) {
            const double z = (k + 0.5) / rings, phi = 2 * pi * (m + 0.5) / spokes, r = std::sqrt(1 - z * z);
            directions.push_back({r * math::cos(phi), r * math::sin(phi), z});
        }
    std::vector<double> positive = at(directions);
    std::erase_if(positive, [](double p) { return !(p > 0); });
    if (2 * positive.size() < directions.size()) return out;
    std::ranges::sort(positive);
    if (positive[positive.size() / 2] > peak_ / 100) return out;
    const double low = positive[positive.size() / 20];
    out.decades = std::clamp(static_cast<int>(std::ceil(math::log10(peak_ / low))), 2, 6);
    return out;
}

double Density::in_plane(double angle) const { return at(in_incidence(angle)); }

// ---- Logarithmic axes around all values that can be drawn, a factor of 1.16 wider in N and of 1.4 in the value on
// each side. Names are at the ends of curves, moved apart. Lengths in pixels.

namespace {

struct Axes {
    Rect plot;
    Axis n_axis, value_axis;
    double x(double n) const { return plot.x + plot.w * n_axis.share(n); }
    double y(double v) const { return plot.bottom() - plot.h * value_axis.share(v); }
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
    for (const double v : a.value_axis.ticks) {
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
    for (const LadderCurve& l : curves)
        ends.push_back(a.value_axis.can_hold(l.value.back()) ? a.y(l.value.back()) : a.plot.y);
    return moved_apart(ends, pitch, a.plot.y - 30 + pitch, a.plot.bottom() + 12 - pitch / 2);
}

// Draws each name with its slope, and under it the slope's interval if there is room for two lines.
void draw_names(Canvas& c, const Axes& a, const std::vector<LadderCurve>& curves) {
    double pitch = std::min(44.0, (a.plot.h + 30) / double(curves.size()));
    bool has_two_lines = pitch >= 40;
    double h = has_two_lines ? 22 : std::min(24.0, pitch);
    std::vector<double> places = name_places(a, curves, has_two_lines ? 44 : std::min(pitch, 24.0));
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const LadderCurve& l = curves[i];
        Rect line{a.plot.right() + 10, places[i] - h / 2, 178, h};
        Text style = with(with(with_px(body_text, 17), l.ink), Vertical::middle);
        style.least_px = 9;
        c.text(line, slope_text(l), style);
        if (!has_two_lines || l.heavy || !std::isfinite(l.low) || !std::isfinite(l.high)) continue;
        line.y += h - 2;
        line.h = 20;
        c.text(line, signed_number(l.low) + " to " + signed_number(l.high), small_text);
    }
}

void draw_interval(Canvas& c, const Axes& a, double n, const std::pair<double, double>& ends, const Colour& ink) {
    if (!a.value_axis.can_hold(ends.first) || !a.value_axis.can_hold(ends.second)) return;
    const double x = a.x(n), low = a.y(ends.first), high = a.y(ends.second);
    c.line(x, low, x, high, ink, 1.5);
    for (const double y : {low, high}) c.line(x - 4, y, x + 4, y, ink, 1.5);
}

}  // namespace

std::vector<LadderCurve> ladder_curves(const Sheet& sheet, const std::string& region) {
    const Experiment& e = sheet.experiment();
    const std::vector<RunKey> keys = keys_of(sheet.plan, e);
    std::vector<LadderCurve> out;
    for (const Ladder& l : sheet.in.metrics.ladders) {
        const bool is_shown =
            keys.empty() || std::any_of(keys.begin(), keys.end(), [&](const RunKey& k) { return k.arm == l.arm; });
        if (!is_shown || l.region != region || l.s != e.s() || l.n.size() < 2) continue;
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
            if (a.value_axis.can_hold(l.value[k])) path.push_back({a.x(l.n[k]), a.y(l.value[k])});
            if (k < l.interval.size()) draw_interval(c, a, l.n[k], l.interval[k], l.ink);
        }
        c.polyline(path, l.ink, 2.5);
        for (const Canvas::Point& p : path) c.dot(p.x, p.y, 4, l.ink);
    }
    draw_names(c, a, curves);
}

}  // namespace crescent::plates
