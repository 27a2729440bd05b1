// The plate's kind selects its painter from the list in experiment/experiment.h; caption and footer are set after it.
#include "report/plates/plates.h"

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <fmt/format.h>
#include <png.h>

#include "base/errors.h"
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
        const auto entry = std::find_if(out.begin() + static_cast<std::ptrdiff_t>(regions), out.end(),
            [&](const Marked& m) { return m.box == *plate.crop; });
        if (entry == out.end())
            out.push_back({plate.name, std::to_string(out.size() - regions + 1), *plate.crop, bright, true});
        else entry->name += ", " + plate.name;
    }
    return out;
}

/// White on black, which is visible on any photograph and in any theme.
void dashed(Sheet& sheet, const Rect& r) {
    const std::vector<Canvas::Point> path = {
        {r.x, r.y}, {r.right(), r.y}, {r.right(), r.bottom()}, {r.x, r.bottom()}, {r.x, r.y}};
    sheet.canvas.polyline(path, {0, 0, 0, 0.6}, 4);
    sheet.canvas.polyline(path, {1, 1, 1}, 2, 6);
}

/// Draws numbers under the picture and next to it, and faint lines through it.
void rulers(Sheet& sheet, const Rect& picture, const View& v) {
    const double step = std::max(1.0, round_up(std::max(v.width, v.height) / 10.0));
    const Colour grid{1, 1, 1, 0.16};
    const Text x_label = with(with_px(small_text, 14), Align::centre),
               y_label = with(with_px(small_text, 14), Align::right);
    for (double x = 0; x < v.width; x += step) {
        const double tick = picture.x + (x + 0.5) / v.width * picture.w;
        sheet.canvas.line(tick, picture.y, tick, picture.bottom(), grid, 1);
        sheet.canvas.line(tick, picture.bottom(), tick, picture.bottom() + 5, muted, 1);
        sheet.canvas.text({tick - 24, picture.bottom() + 7, 48, 20}, fmt::format("{:.0f}", x), x_label);
    }
    for (double y = 0; y < v.height; y += step) {
        const double tick = picture.bottom() - (y + 0.5) / v.height * picture.h;
        sheet.canvas.line(picture.x, tick, picture.right(), tick, grid, 1);
        sheet.canvas.line(picture.x - 5, tick, picture.x, tick, muted, 1);
        sheet.canvas.text({picture.x - ruler_w, tick - 10, ruler_w - 8, 20}, fmt::format("{:.0f}", y), y_label);
    }
}

void outline(Sheet& sheet, const Rect& r, const Marked& m) {
    if (m.crop) return dashed(sheet, r);
    outline_over(sheet.canvas, r, m.colour);
}

/// Lists crops by the number that they have on the picture.
void list_boxes(Sheet& sheet, const std::vector<Marked>& boxes, double y) {
    const Text tag_text = with(with(with_px(small_text, 14), Align::centre), Vertical::middle);
    Rect line{facts_slot.x, y + 14, facts_slot.w, 24};
    for (std::size_t i = 0; i < boxes.size(); ++i, line.y += 50) {
        if (line.y + 46 > facts_slot.bottom()) {
            sheet.notes.push_back(fmt::format("{} of {} boxes listed", i, boxes.size()));
            break;
        }
        const Marked& m = boxes[i];
        const Rect swatch{line.x, line.y + 2, 20, 20};
        sheet.canvas.fill(swatch, m.colour);
        if (m.crop) sheet.canvas.text(swatch, m.tag, with(with(tag_text, ground), Weight::semibold));
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
    const auto place_of = [&](const Marked& m) { return on_picture(picture, whole(v), inside(m.box, v)).inset(-1.5); };
    for (const Marked& m : boxes) outline(sheet, place_of(m), m);
    for (const Marked& m : boxes) name_tag(sheet, picture, place_of(m), m.tag, m.colour);
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

// ---- PNG, ISO/IEC 15948:2004: 8-bit RGB, sRGB chunk, provenance as tEXt (Latin-1) or iTXt (UTF-8); no time, so that
// equal pictures have equal bytes.

namespace {

// zlib level and filter: noise is hardly compressible, and level 3 with one filter takes a third of the time of the
// defaults for a few per cent more bytes.
constexpr int deflate_level = 3;

void append(png_structp png, png_bytep data, png_size_t n) {
    auto* out = static_cast<std::vector<unsigned char>*>(png_get_io_ptr(png));
    out->insert(out->end(), data, data + n);
}
void keep(png_structp) {}

[[noreturn]] void fail(png_structp png, png_const_charp message) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = message;
    longjmp(png_jmpbuf(png), 1);
}
void ignore(png_structp, png_const_charp) {}

bool ascii(const std::string& s) {
    return std::all_of(s.begin(), s.end(), [](unsigned char c) { return c < 128; });
}

// Everything with a destructor is owned by the caller: libpng leaves by longjmp.
bool write(png_structp png, png_infop info, const Picture& p, std::vector<png_text>& text) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_IHDR(png, info, png_uint_32(p.width), png_uint_32(p.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
        PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(png, deflate_level);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!text.empty()) png_set_text(png, info, text.data(), int(text.size()));
    png_write_info(png, info);
    for (int y = 0; y < p.height; ++y) {
        png_write_row(png, const_cast<png_bytep>(p.rgb.data() + 3 * std::size_t(y) * std::size_t(p.width)));
    }
    png_write_end(png, nullptr);
    return true;
}

}  // namespace

std::vector<unsigned char> encode_png(
    const Picture& picture, const std::vector<std::pair<std::string, std::string>>& text) {
    ensure(picture.width > 0 && picture.height > 0 &&
            picture.rgb.size() == 3 * std::size_t(picture.width) * std::size_t(picture.height),
        "a picture has three bytes a pixel");
    std::vector<png_text> chunks;
    for (const auto& [key, value] : text) {
        ensure(!key.empty() && key.size() < 80 && ascii(key), "a PNG keyword has 1 to 79 ASCII characters");
        png_text t{};
        t.compression = ascii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        t.key = const_cast<char*>(key.c_str());
        t.text = const_cast<char*>(value.c_str());
        (ascii(value) ? t.text_length : t.itxt_length) = value.size();
        chunks.push_back(t);
    }
    std::vector<unsigned char> out;
    std::string error;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, fail, ignore);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    bool is_written = false;
    if (info) {
        png_set_write_fn(png, &out, append, keep);
        is_written = write(png, info, picture, chunks);
    }
    png_destroy_write_struct(&png, &info);
    if (!is_written) throw OutputError("PNG: " + (error.empty() ? std::string("out of memory") : error));
    return out;
}

}  // namespace crescent::plates
