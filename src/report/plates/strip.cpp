// columns, ladder, exponent, surround: runs side by side as photographs. On top each frame, equally reduced; under it
// the same crop of each, equally enlarged; under that the difference of the run from its neighbours.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/plates/sheet.h"

namespace crescent::plates {

namespace {

constexpr double picture_gap = 12;  // frame and crop

struct Varies {
    bool arm = false, n = false, s = false;
    explicit Varies(const std::vector<RunKey>& runs) {
        for (const RunKey& r : runs) {
            arm |= r.arm != runs[0].arm;
            n |= r.n != runs[0].n;
            s |= r.s != runs[0].s;
        }
    }
};

std::string heading(const RunKey& r, const Varies& v, const Experiment& e) {
    std::vector<std::string> parts;
    if (v.arm || (!v.n && !v.s)) parts.push_back(arm_name(r.arm, e));
    if (v.n) parts.push_back("N = " + count(r.n));
    if (v.s) parts.push_back("s = " + number(r.s));
    return joined(parts, ", ");
}

// Returns the middle third of a box that is more than half of the picture, which would show what the frame shows; else
// the box.
Box detail_of(const Box& box, const Image& image) {
    if (2.0 * box.width() * box.height() <= double(image.width) * image.height) return box;
    const int dx = box.width() / 3, dy = box.height() / 3;
    return {box.x0 + dx, box.y0 + dy, box.x1 - dx, box.y1 - dy};
}

// Returns the crop of the plan; else of the first region for the highlight, of the last for the surround; else nothing.
std::optional<Box> crop_of(const Sheet& sheet) {
    const auto& regions = sheet.experiment().regions;
    if (sheet.plan.crop) return sheet.plan.crop;
    if (regions.empty()) return {};
    const Region& region = sheet.plan.kind == PlateKind::surround ? regions.back() : regions.front();
    return detail_of(region.box, sheet.experiment().image);
}

constexpr double density_line_h = 23;

// The layout, the same in every cell. Up to six runs are in one row; more make a grid of crops.
struct Layout {
    std::size_t columns = 1, rows = 1;
    bool frames = true, crops = false;
    double words_h = 0, frame_h = 0, crop_h = 0, top = 0;  // top: of the pictures in their cell
    int density_lines = 0;
    Fit frame, crop;
    Rect cell(std::size_t i) const {
        double h = (content_band.h - gap * double(rows - 1)) / double(rows);
        Rect band{content_band.x, content_band.y + double(i / columns) * (h + gap), content_band.w, h};
        return column(band, columns, i % columns);
    }
};

std::string density_of(const RunKey& run, const Varies& varies, const Experiment& e) {
    return varies.s ? density_formula_at(run.arm, run.s, e) : density_formula(run.arm, e);
}

Text density_text() { return with(with(with_px(body_text, 17), muted), Align::centre); }

// Returns how many lines the longest density takes, with a tenth of a line for what breaking at words leaves empty.
int density_lines(const Sheet& sheet, const std::vector<RunKey>& runs, const Varies& varies, double width) {
    constexpr int most_lines = 4;
    const Text smallest = with_px(density_text(), density_text().least_px);
    double longest = 0;
    for (const RunKey& run : runs)
        longest = std::max(longest, sheet.canvas.measure(density_of(run, varies, sheet.experiment()), smallest).w);
    if (longest <= width) return 1;
    return std::min(most_lines, static_cast<int>(std::ceil(1.1 * longest / width)));
}

Layout lay_out(
    const Sheet& sheet, const std::vector<RunKey>& runs, const Varies& varies, const std::optional<Box>& crop) {
    const Image& image = sheet.experiment().image;
    const std::size_t count = runs.size();
    Layout l;
    l.columns = count <= 6 ? count : std::max<std::size_t>(6, std::size_t(std::ceil(std::sqrt(1.8 * double(count)))));
    l.rows = (count + l.columns - 1) / l.columns;
    const bool has_density = l.rows == 1 && (varies.arm || varies.s);
    l.density_lines = has_density ? density_lines(sheet, runs, varies, l.cell(0).w) : 0;
    l.words_h = has_density ? 35 + density_line_h * l.density_lines : 36;
    double w = l.cell(0).w, room = l.cell(0).h - l.words_h;
    l.crops = crop.has_value();
    l.frames = !l.crops || (sheet.plan.kind != PlateKind::surround && l.rows == 1);
    if (l.frames) {
        l.frame = fit(image.width, image.height, std::floor(w), std::floor(l.crops ? room / 2 : room));
        l.frame_h = l.frame.out_h;
    }
    if (l.crops) {
        double height_left = room - (l.frames ? l.frame_h + picture_gap : 0);
        l.crop = fit(crop->width(), crop->height(), std::floor(w), std::floor(height_left));
        l.crop_h = l.crop.out_h;
    }
    double height = l.frame_h + l.crop_h + (l.frames && l.crops ? picture_gap : 0) + l.words_h;
    l.top = std::floor((l.cell(0).h - height) / 2);
    return l;
}

void draw_pictures(Sheet& sheet, const View& v, const Rect& col, const Layout& l, const std::optional<Box>& crop) {
    const double exposure = sheet.experiment().exposure;
    Rect slot{col.x, col.y + l.top, col.w, l.frame_h};
    Box frame = whole(v);
    if (l.frames) {
        Rect r = paint_framed(sheet, photograph_block(v, frame, l.frame, exposure), slot);
        if (l.crops) outline_over(sheet.canvas, on_picture(r, frame, *crop).inset(-1), photograph_accent);
        slot.y += l.frame_h + picture_gap;
    }
    if (l.crops) {
        slot.h = l.crop_h;
        Rect r = paint_framed(sheet, photograph_block(v, *crop, l.crop, exposure), slot);
        if (l.frames) sheet.canvas.outline(r.inset(-1), photograph_accent, 1.5);
    }
    sheet.not_finite += not_finite(v, l.frames ? frame : *crop);
}

void draw_words(Sheet& sheet, const RunKey& run, const Varies& varies, const Layout& l, const Rect& col) {
    const Experiment& e = sheet.experiment();
    double y = col.bottom() - l.top - l.words_h;
    sheet.canvas.text({col.x, y + 8, col.w, 28}, heading(run, varies, e), with(with_px(title_text, 22), Align::centre));
    if (l.density_lines == 0) return;
    sheet.canvas.text({col.x, y + 35, col.w, density_line_h * l.density_lines}, density_of(run, varies, e),
        with_lines(density_text(), l.density_lines));
}

void add_notes(Sheet& sheet, const Layout& l, const std::optional<Box>& crop) {
    if (l.frames) {
        std::string method = l.frame.reduced ? "area average in linear light, then tone-mapped" : "pixels as they are";
        sheet.notes.push_back(fmt::format("frames {} ({})", to_string(l.frame), method));
    }
    if (l.crops) {
        std::string method = l.crop.reduced ? " (area average in linear light)" : ", pixels as they are";
        sheet.notes.push_back(fmt::format(
            "crop x {}–{}, y {}–{}, {}{}", crop->x0, crop->x1, crop->y0, crop->y1, to_string(l.crop), method));
    }
    sheet.notes.push_back(fmt::format("exposure {}", number(sheet.experiment().exposure)));
}

}  // namespace

void draw_strip(Sheet& sheet) {
    const Experiment& e = sheet.experiment();
    std::vector<RunKey> runs = keys_of(sheet.plan, e);
    if (runs.empty()) {
        photograph_header(sheet, "no runs", "");
        paint_missing(sheet, content_band, "the plan names no run");
        return;
    }
    photograph_header(sheet, runs_label(runs, e), stream_words(runs));
    View frame;
    frame.width = e.image.width;
    frame.height = e.image.height;
    std::optional<Box> crop = crop_of(sheet);
    if (crop) crop = inside(*crop, frame);
    Varies varies(runs);
    Layout l = lay_out(sheet, runs, varies, crop);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        Rect col = l.cell(i);
        View v = view(sheet.in.film(runs[i]));
        if (v.width > 0) {
            draw_pictures(sheet, v, col, l, crop);
        } else {
            paint_missing(sheet, {col.x, col.y + l.top, col.w, col.h - 2 * l.top - l.words_h},
                escaped(to_string(runs[i])) + " was not run");
        }
        draw_words(sheet, runs[i], varies, l, col);
    }
    add_notes(sheet, l, crop);
}

}  // namespace crescent::plates
