// The plate's kind selects its painter from the list in experiment/experiment.h; caption and footer are set after it.
#include "report/plates/plates.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "experiment/experiment.h"
#include "output/charts.h"
#include "report/plates/sheet.h"

namespace crescent::plates {

namespace {

/// By PlateKind.
#define CRESCENT_PAINTER(name, painter, ...) draw_##painter,
constexpr void (*painters[])(Sheet&) = {CRESCENT_PLATES(CRESCENT_PAINTER)};
#undef CRESCENT_PAINTER

}  // namespace

void draw(Sheet& sheet) {
    painters[static_cast<std::size_t>(sheet.plan.kind)](sheet);
    finish(sheet);
}

std::string draw_plate_svg(const PlatePlan& plan, const PlateInputs& in) {
    if (plate_info(plan.kind).look != PlateLook::drawing) return {};
    Sheet sheet(plan, in, Medium::svg);
    draw(sheet);
    return sheet.canvas.svg();
}

Picture draw_plate(const PlatePlan& plan, const PlateInputs& in) {
    Sheet sheet(plan, in);
    draw(sheet);
    return sheet.canvas.picture();
}

// ---- The preview of an experiment: the reference with pixel rulers, regions outlined, crops dashed, and every box as
// it is written in the file, [x0, y0, x1, y1] from the bottom-left, both ends inclusive.

namespace {

constexpr double ruler_w = 46, ruler_h = 28;

struct Marked {
    std::string name, tag;  // tag: on the picture, a region's name or a crop's number
    Box box;
    Colour colour;
    bool crop = false;
};

/// Regions, then crops; plates with the same crop share one.
std::vector<Marked> marked(const Experiment& e) {
    std::vector<Marked> out;
    for (std::size_t i = 0; i < e.regions.size(); ++i)
        out.push_back({e.regions[i].name, e.regions[i].name, e.regions[i].box, region_colour(i)});
    const std::size_t regions = out.size();
    for (const PlatePlan& plate : e.plates) {
        if (!plate.crop) continue;
        const auto same = std::find_if(out.begin() + static_cast<std::ptrdiff_t>(regions), out.end(),
            [&](const Marked& m) { return m.box == *plate.crop; });
        if (same == out.end())
            out.push_back({plate.name, std::to_string(out.size() - regions + 1), *plate.crop, bright, true});
        else same->name += ", " + plate.name;
    }
    return out;
}

/// White on black, which is visible on any photograph and in any theme.
void dashed(Sheet& sheet, const Rect& r) {
    const std::vector<Canvas::Point> around = {
        {r.x, r.y}, {r.right(), r.y}, {r.right(), r.bottom()}, {r.x, r.bottom()}, {r.x, r.y}};
    sheet.canvas.polyline(around, {0, 0, 0, 0.6}, 4);
    sheet.canvas.polyline(around, {1, 1, 1}, 2, 6);
}

/// Draws numbers under the picture and next to it, and faint lines through it.
void rulers(Sheet& sheet, const Rect& picture, const View& v) {
    const double step = std::max(1.0, round_up(std::max(v.width, v.height) / 10.0));
    const Colour grid{1, 1, 1, 0.16};
    const Text under = with(with_px(small_text, 14), Align::centre),
               beside = with(with_px(small_text, 14), Align::right);
    for (double x = 0; x < v.width; x += step) {
        const double at = picture.x + (x + 0.5) / v.width * picture.w;
        sheet.canvas.line(at, picture.y, at, picture.bottom(), grid, 1);
        sheet.canvas.line(at, picture.bottom(), at, picture.bottom() + 5, muted, 1);
        sheet.canvas.text({at - 24, picture.bottom() + 7, 48, 20}, fmt::format("{:.0f}", x), under);
    }
    for (double y = 0; y < v.height; y += step) {
        const double at = picture.bottom() - (y + 0.5) / v.height * picture.h;
        sheet.canvas.line(picture.x, at, picture.right(), at, grid, 1);
        sheet.canvas.line(picture.x - 5, at, picture.x, at, muted, 1);
        sheet.canvas.text({picture.x - ruler_w, at - 10, ruler_w - 8, 20}, fmt::format("{:.0f}", y), beside);
    }
}

void outline(Sheet& sheet, const Rect& r, const Marked& m) {
    if (m.crop) return dashed(sheet, r);
    outline_over(sheet.canvas, r, m.colour);
}

/// Lists crops by the number that they have on the picture.
void list_boxes(Sheet& sheet, const std::vector<Marked>& all, double y) {
    const Text inside = with(with(with_px(small_text, 14), Align::centre), Vertical::middle);
    Rect line{facts_slot.x, y + 14, facts_slot.w, 24};
    for (std::size_t i = 0; i < all.size(); ++i, line.y += 50) {
        if (line.y + 46 > facts_slot.bottom()) {
            sheet.notes.push_back(fmt::format("{} of {} boxes listed", i, all.size()));
            break;
        }
        const Marked& m = all[i];
        const Rect swatch{line.x, line.y + 2, 20, 20};
        sheet.canvas.fill(swatch, m.colour);
        if (m.crop) sheet.canvas.text(swatch, m.tag, with(with(inside, ground), Weight::semibold));
        sheet.canvas.text({line.x + 30, line.y, line.w - 30, 24}, (m.crop ? "crop of " : "region ") + escaped(m.name),
            with(with_px(body_text, 16), Weight::semibold));
        sheet.canvas.text({line.x + 30, line.y + 24, line.w - 30, 20},
            fmt::format("[{}, {}, {}, {}]", m.box.x0, m.box.y0, m.box.x1, m.box.y1), small_text);
    }
}

}  // namespace

PlatePlan preview_plan(const Experiment& e) {
    PlatePlan plan;
    plan.name = "preview";
    plan.kind = PlateKind::reference;
    plan.caption = (e.title.empty() ? e.file : e.title) +
        ": what all arms would show without noise, with the regions that are measured and the crops that plates "
        "enlarge.";
    return plan;
}

void paint_preview(Sheet& sheet) {
    const Experiment& e = sheet.experiment();
    backend_header(sheet, "PREVIEW", "pixels from the bottom-left", "", false);
    const View v = view(sheet.in.reference(e.s()));
    const std::vector<Marked> boxes = marked(e);
    Rect slot{picture_slot.x + ruler_w, picture_slot.y, picture_slot.w - ruler_w, picture_slot.h - ruler_h};
    const Fit f = fit(v.width, v.height, slot.w, slot.h);
    slot.y += std::floor((slot.h - f.out_h) / 2);
    const Rect picture = paint_photograph(sheet, v, whole(v), slot);
    rulers(sheet, picture, v);
    const auto place = [&](const Marked& m) { return on_picture(picture, whole(v), inside(m.box, v)).inset(-1.5); };
    for (const Marked& m : boxes) outline(sheet, place(m), m);
    for (const Marked& m : boxes) name_tag(sheet, picture, place(m), m.tag, m.colour);
    sheet.notes.push_back("drawn through Khronos PBR Neutral, exposure " + number(e.exposure) + ", " + to_string(f));
    const double y =
        facts(sheet, "Preview", reference_words(e), {{"image", fmt::format("{} × {}", e.image.width, e.image.height)}});
    list_boxes(sheet, boxes, y);
    finish(sheet);
}

Picture draw_preview(const PlateInputs& in) {
    const PlatePlan plan = preview_plan(in.experiment);
    Sheet sheet(plan, in);
    paint_preview(sheet);
    return sheet.canvas.picture();
}

}  // namespace crescent::plates
