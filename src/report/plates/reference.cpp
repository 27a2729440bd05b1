// reference: the film the metrics compare with, its regions outlined and named.
#include <fmt/format.h>

#include <cmath>

#include "experiment/experiment.h"
#include "report/plates/sheet.h"

namespace crescent::plates {

namespace {

void outline_region(Sheet& sheet, const Rect& picture, const View& v, const Region& region, const Colour& c) {
    Rect r = on_picture(picture, whole(v), inside(region.box, v)).inset(-1.5);
    outline_over(sheet.canvas, r, c);
    name_tag(sheet, picture, r, region.name, c);
}

void region_facts(Sheet& sheet, const View& v, double y) {
    const auto& regions = sheet.experiment().regions;
    Rect line{facts_slot.x, y + 18, facts_slot.w, 24};
    for (std::size_t i = 0; i < regions.size(); ++i) {
        if (line.y + 98 > facts_slot.bottom()) {
            sheet.notes.push_back(fmt::format("{} of {} regions listed", i, regions.size()));
            break;
        }
        const Box& b = regions[i].box;
        const AreaPixels pixels(regions[i].area(), sheet.in.shapes);
        sheet.canvas.fill({line.x, line.y + 3, 18, 18}, region_colour(i));
        sheet.canvas.text({line.x + 28, line.y, line.w - 28, 24}, "region " + escaped(regions[i].name),
            with(body_text, Weight::semibold));
        sheet.canvas.text(
            {line.x, line.y + 27, line.w, 20}, fmt::format("x {}–{}, y {}–{}", b.x0, b.x1, b.y0, b.y1), small_text);
        sheet.canvas.text({line.x, line.y + 47, line.w, 20},
            count(pixels.count()) + " pixels" +
                (regions[i].object().empty() ? "" : " of " + escaped(regions[i].object())),
            small_text);
        if (v.width > 0) {
            const double mean = pixels.mean([&](std::size_t index) { return double(v.y[index]); });
            sheet.canvas.text(
                {line.x, line.y + 67, line.w, 20}, "mean Y " + figure(mean) + " " + radiance_unit, small_text);
        }
        line.y += 104;
    }
}

}  // namespace

void draw_reference(Sheet& sheet) {
    const Experiment& e = sheet.experiment();
    double s = sheet.plan.runs.empty() ? e.s() : key_of(sheet.plan.runs[0], e).s;
    View v = view(sheet.in.reference(s));
    backend_header(sheet, "REFERENCE",
        "not a sampling arm" + (any_tells_s(e) || e.exponent ? " / s=" + number(s) : std::string()),
        reference_stream(e), false);
    if (v.width > 0) {
        Fit f = fit(v.width, v.height, picture_slot.w, picture_slot.h);
        Rect slot = picture_slot;
        slot.y += std::floor((slot.h - f.out_h) / 2);
        Rect picture = paint_photograph(sheet, v, whole(v), slot);
        for (std::size_t i = 0; i < e.regions.size(); ++i) {
            outline_region(sheet, picture, v, e.regions[i], region_colour(i));
        }
        sheet.notes.push_back(
            "drawn through Khronos PBR Neutral, exposure " + number(e.exposure) + ", " + to_string(f));
        sheet.notes.push_back("means off the float film");
    } else {
        paint_missing(sheet, picture_slot, with_exponent("no reference", s));
    }
    std::vector<Fact> list = exponent_facts(s);
    list.push_back({"image", fmt::format("{} × {}", e.image.width, e.image.height)});
    double y = facts(sheet, "Reference", reference_words(e), list);
    region_facts(sheet, v, y);
}

}  // namespace crescent::plates
