// rose: the densities in 1/sr, each over the hemisphere of n as a dome in turbo colours, and under it in the plane of
// incidence as a polar plot. Nothing is sampled: the numbers are the samplers' own pdf.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/functions.h"
#include "output/tone_map.h"
#include "render/combination.h"
#include "report/plates/charts.h"
#include "report/plates/sheet.h"
#include "samplers/info.h"

namespace crescent::plates {

namespace {

using Direction = Vec3d;
// R has this angle from n, in the xz plane: enough to distinguish R from n, far enough from the horizon to show the
// lobe.
constexpr double tilt_deg = 30;
// At the right of each half, for the colour bar and the legend.
constexpr double scale_room = 128;
// The dome is seen from 45 deg above the surface, across the plane of incidence.
const double view_sine = math::sin(45 * radians_per_degree), view_cosine = math::cos(45 * radians_per_degree);

struct Dome {
    double x = 0, y = 0, radius = 0;  // centre of the base on the sheet
    Canvas::Point at(const Direction& d, double reach = 1) const {
        return {x + reach * radius * d.x, y - reach * radius * (d.z * view_cosine + d.y * view_sine)};
    }
    static bool visible(const Direction& d) {
        return d.z * view_sine - d.y * view_cosine >= -1e-9;
    }  // the rim's two ends lie on the edge
};

Direction from_angles(double theta, double phi) {
    return {math::sin(theta) * math::cos(phi), math::sin(theta) * math::sin(phi), math::cos(theta)};
}

// Returns the dome's pixels: the part of the sphere towards the viewer and above the surface.
Block dome_block(const Density& p, const DensityScale& scale, int r, const Srgb8& nothing) {
    Block block(2 * r, static_cast<int>(std::ceil(r * (1 + view_sine))));
    std::vector<Direction> directions;
    std::vector<std::pair<int, int>> pixels;
    for (int j = 0; j < block.height; ++j) {
        for (int i = 0; i < block.width; ++i) {
            double u = (i + 0.5) / r - 1, v = 1 - (j + 0.5) / r, w2 = 1 - u * u - v * v;
            double w = w2 > 0 ? std::sqrt(w2) : 0;
            Direction d{u, v * view_sine - w * view_cosine, v * view_cosine + w * view_sine};
            block.set(i, j, nothing);
            if (w2 > 0 && d.z >= 0) {
                directions.push_back(d);
                pixels.emplace_back(i, j);
            }
        }
    }
    const std::vector<double> density = p.at(directions);
    for (std::size_t k = 0; k < directions.size(); ++k)
        block.set(pixels[k].first, pixels[k].second, turbo(scale.share(density[k])));
    return block;
}

void trace(Canvas& c, const Dome& dome, const std::vector<Direction>& path, const Colour& ink, double width) {
    std::vector<Canvas::Point> run;
    for (const Direction& d : path) {
        if (Dome::visible(d)) {
            run.push_back(dome.at(d));
        } else {
            c.polyline(run, ink, width);
            run.clear();
        }
    }
    c.polyline(run, ink, width);
}

// Circles of equal polar angle and meridians every 30 deg, the rim, and the outline.
void draw_grid(Canvas& c, const Dome& dome) {
    constexpr Colour thin{1, 1, 1, 0.28};
    for (int theta = 30; theta <= 90; theta += 30) {
        std::vector<Direction> ring;
        for (int k = 0; k <= 120; ++k)
            ring.push_back(from_angles(theta * radians_per_degree, k * 3 * radians_per_degree));
        trace(c, dome, ring, theta == 90 ? muted : thin, theta == 90 ? 2 : 1);
    }
    for (int phi = 0; phi < 360; phi += 30) {
        std::vector<Direction> meridian;
        for (int k = 0; k <= 60; ++k)
            meridian.push_back(from_angles(k * 1.5 * radians_per_degree, phi * radians_per_degree));
        trace(c, dome, meridian, thin, 1);
    }
    std::vector<Canvas::Point> rim;
    for (int k = 0; k <= 120; ++k) {
        double a = k * 1.5 * radians_per_degree;
        rim.push_back({dome.x + dome.radius * math::cos(a), dome.y - dome.radius * math::sin(a)});
    }
    c.polyline(rim, muted, 2);
}

void draw_arrow(Canvas& c, const Dome& dome, const Direction& d, const std::string& name, double side) {
    Canvas::Point foot = dome.at(d), tip = dome.at(d, 1.62);
    c.arrow(foot, tip, bright, 2.5);
    Text style = with(with(body_text, Weight::semibold), side < 0 ? Align::right : Align::left);
    double x = side < 0 ? tip.x - 48 : tip.x + 8;
    c.text({x, tip.y - 8, 40, 24}, name, style);
}

struct Part {
    RunKey key;
    Density p;
    double peak = p.peak();
    DensityScale scale = p.scale();
};

void draw_dome(Sheet& sheet, const Part& part, const Rect& slot) {
    double head = 26;  // above the dome, for the tips of the arrows
    int r = static_cast<int>(std::min((slot.w - scale_room - 24) / 2, (slot.h - head) / (1 + view_sine)));
    if (r < 8) return;
    Dome dome{std::floor(slot.x + (slot.w - scale_room) / 2), slot.y + head + r, double(r)};
    sheet.canvas.paint(
        dome_block(part.p, part.scale, r, ground_pixel(sheet.canvas.theme())), int(dome.x) - r, int(slot.y + head));
    draw_grid(sheet.canvas, dome);
    draw_arrow(sheet.canvas, dome, {0, 0, 1}, "n", -1);
    draw_arrow(sheet.canvas, dome, {math::sin(part.p.tilt()), 0, math::cos(part.p.tilt())}, "R", 1);
    Rect bar{slot.right() - scale_room + 24, slot.y + head + 8, 22, std::floor(dome.radius * (1 + view_sine)) - 8};
    sheet.canvas.text({bar.x, slot.y - 2, scale_room - 24, 22}, "p, 1/sr", with_px(small_text, 16));
    colour_bar(sheet, bar, part.peak, false, part.scale.decades);
}

/// Returns null if the sampler is built in, or if there is none to evaluate.
const SamplerAdapter* from_external(const Sheet& sheet, const std::string& arm) {
    return sheet.in.external_sampler ? sheet.in.external_sampler(arm) : nullptr;
}

std::vector<Part> parts_of(const Sheet& sheet, double tilt) {
    const Experiment& e = sheet.experiment();
    std::vector<RunKey> keys = keys_of(sheet.plan, e);
    if (keys.empty()) {
        for (const ArmPlan& a : e.arms) keys.push_back({a.name, 0, e.s(), e.seed});
    }
    std::vector<Part> parts;
    for (const RunKey& k : keys) {
        const SamplerAdapter* external = from_external(sheet, k.arm);
        parts.push_back({k, external ? Density(e, *external, k.s, tilt) : Density(e, sampler_of(k.arm, e), k.s, tilt)});
    }
    return parts;
}

// Draws title, density and peak; returns the y under them. In a narrow column the peak has a line of its own.
double draw_words(Sheet& sheet, const std::vector<Part>& parts, std::size_t i, const Rect& col, bool narrow) {
    const Experiment& e = sheet.experiment();
    const Part& part = parts[i];
    std::string axis = axis_of(part.key.arm, e);
    std::string title = arm_name(part.key.arm, e) + (axis.empty() ? "" : " about " + axis);
    sheet.canvas.text({col.x, col.y, col.w, 30}, title, with_px(title_text, 22));
    std::string formula = density_formula_at(part.key.arm, part.key.s, e);
    std::string peak = part.peak > 0 ? "peak " + number(part.peak, 3) + " sr<sup>−1</sup>" : "";
    if (i > 0 && part.peak > 0 && parts[0].peak > 0) {
        peak += fmt::format(" = {} × {}", number(part.peak / parts[0].peak, 3), arm_name(parts[0].key.arm, e));
    }
    Text style = with(with_px(body_text, 17), muted);
    Rect line{col.x, col.y + 31, col.w, 24};
    if (!narrow && !peak.empty()) formula += ",  " + peak;
    sheet.canvas.text(line, formula, style);
    if (narrow) sheet.canvas.text({line.x, line.y + 25, line.w, line.h}, peak, style);
    return line.y + (narrow ? 56 : 31);
}

/// Returns the largest density in the plane of incidence, or anywhere if the sampler returns no sample in that plane.
double peak_in_plane(const Part& part) {
    double peak = 0;
    for (int i = -900; i <= 900; ++i) peak = std::max(peak, part.p.in_plane(i * 0.1 * radians_per_degree));
    return peak > 0 ? peak : part.peak;
}

/// Returns why no density is shown for an arm.
std::string why_no_density(const Sheet& sheet, const std::string& arm) {
    const Experiment& e = sheet.experiment();
    const SamplerInfo* info = find_arm_info(sampler_of(arm, e));
    const SamplerAdapter* external = from_external(sheet, arm);
    const SamplerDeclaration declared = external ? external->declaration() : SamplerDeclaration{};
    return arm_name(arm, e) +
        (combination_of(external)                     ? " joins several densities, each with its own weight"
                : declared.uses_lights()              ? " uses lights, and there are none here"
                : external && declared.traits.has_pdf ? " says that its density is 0 in the plane of incidence"
                : external       ? " is a library without crescent_sampler_pdf: its density is not known"
                : !info          ? " is external, and its density cannot be evaluated"
                : info->combines ? " joins several densities, each with its own weight"
                                 : " aims at lights: none reaches what the camera sees");
}

void draw_part(Sheet& sheet, const std::vector<Part>& parts, std::size_t i) {
    const Experiment& e = sheet.experiment();
    const Part& part = parts[i];
    Rect col = column(content_band, parts.size(), i);
    bool narrow = col.w < 500;
    double y = draw_words(sheet, parts, i, col, narrow);
    Rect dome{col.x, y, col.w, content_band.y + 294 - y};
    if (!(part.peak > 0)) {
        paint_missing(sheet, dome, why_no_density(sheet, part.key.arm));
        return;
    }
    draw_dome(sheet, part, dome);
    PolarPlot plot;
    plot.slot = {col.x, content_band.y + 300, col.w, 240};
    plot.legend_w = narrow ? 0 : scale_room;
    plot.scale = {.top = peak_in_plane(part), .decades = part.scale.decades};
    plot.tilt = part.p.tilt();
    for (std::size_t k = 0; k < parts.size(); ++k) {
        bool is_lower = parts[k].peak < part.peak && parts[k].peak > 0;
        if (k != i && (narrow || !is_lower)) continue;
        plot.curves.push_back({k == i, arm_colour(parts[k].key.arm, e), escaped(parts[k].key.arm),
            [&p = parts[k].p](double a) { return p.in_plane(a); }});
    }
    draw_polar(sheet.canvas, plot);
}

}  // namespace

void draw_rose(Sheet& sheet) {
    double tilt = tilt_deg * radians_per_degree;
    std::vector<Part> parts = parts_of(sheet, tilt);
    std::vector<RunKey> keys;
    for (const Part& p : parts) keys.push_back(p.key);
    const bool logarithmic = std::ranges::any_of(parts, [](const Part& p) { return p.scale.decades > 0; });
    backend_header(sheet, "PDF ROSE",
        (logarithmic ? "pdf in 1/sr / " : "linear pdf in 1/sr / ") +
            (keys.empty() ? "no arms" : runs_label(keys, sheet.experiment(), false)),
        "nothing sampled", false);
    for (std::size_t i = 0; i < parts.size(); ++i) draw_part(sheet, parts, i);
    if (sheet.in.backend == "CPU") sheet.notes.clear();  // nothing was measured
    for (const std::string& note : {fmt::format("R is {}° from n", number(tilt_deg)),
             std::string(
                 "domes seen from 45° above the surface, rings and meridians every 30°, each with its own scale"),
             std::string("polar: plane of incidence")})
        sheet.notes.push_back(note);
    const Experiment& e = sheet.experiment();
    if (const auto surface = surface_of_densities(e); surface && *surface >= e.shapes.size()) {
        const MeshObject& mesh = e.meshes[*surface - e.shapes.size()];
        if (mesh.rho_d_texture.file || mesh.alpha_texture.file)
            sheet.notes.push_back(fmt::format("the material of {} without its textures", escaped(mesh.name)));
    }
    for (const Part& p : parts)
        if (!p.p.where().empty())
            sheet.notes.push_back(fmt::format("{}: {}, R at {}°{}", escaped(p.key.arm), p.p.where(),
                number(p.p.tilt() / radians_per_degree, 3), p.scale.decades > 0 ? ", logarithmic" : ""));
}

}  // namespace crescent::plates
