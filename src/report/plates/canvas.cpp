// Pango sets text at its size, then half a pixel smaller each time until it fits its box; at the smallest size it is
// ellipsized. The text, its place and its size are recorded. Pictures are copied from Cairo's 32-bit pixels.
#include "report/plates/canvas.h"

#include <pango/pangocairo.h>

#include <algorithm>
#include <cairo-svg.h>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <string>

#include "base/errors.h"
#include "base/machine.h"
#include "math/functions.h"
#include "report/plates/sheet.h"

namespace crescent::plates {

// Cairo's surface and context, and Pango's layout.

struct Unref {
    void operator()(gpointer object) const { g_object_unref(object); }
};

struct Canvas::Surface {
    cairo_surface_t* image = nullptr;
    cairo_t* cr = nullptr;
    double scale = 1;
    Theme theme = Theme::dark;
    std::unique_ptr<PangoLayout, Unref> layout;

    std::string document;  // of Medium::svg, once finished

    Surface(int width, int height, double scale, Theme theme, Medium medium);
    ~Surface();
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    void ink(const Colour& c);
    /// Lays out markup at `px`; width < 0: unbounded.
    Rect lay(const std::string& markup, const Text& style, double px, double width);
};

// ---- Points Fontconfig at the fonts that are installed with the program, by its environment variable FONTCONFIG_FILE.

void use_fonts_beside_program() {
    static const bool is_set = [] {
        const std::string config = shared_file("fonts/fonts.conf");
        return !config.empty() && ::setenv("FONTCONFIG_FILE", config.c_str(), 0) == 0;
    }();
    static_cast<void>(is_set);
}

Colour colour(const Srgb8& c) { return {c[0] / 255.0, c[1] / 255.0, c[2] / 255.0, 1}; }

std::string escaped(std::string_view plain) {
    std::unique_ptr<char, decltype(&g_free)> text{g_markup_escape_text(plain.data(), gssize(plain.size())), g_free};
    return text.get();
}

Canvas::Canvas(int width, int height, const Colour& paper, double scale, Theme theme, Medium medium)
    : width_(width),
      height_(height),
      surface_(std::make_unique<Surface>(width, height, scale, theme, medium)),
      theme_(theme) {
    clear(paper);
}

void Canvas::clear(const Colour& paper) {
    surface_->ink(paper);
    cairo_set_line_join(surface_->cr, CAIRO_LINE_JOIN_MITER);  // polylines change it
    cairo_paint(surface_->cr);
    settings_.clear();
    pictures_.clear();
}

Canvas::~Canvas() = default;

Rect Canvas::measure(const std::string& markup, const Text& style) const {
    Text line_style = style;
    line_style.lines = 1;
    return surface_->lay(markup, line_style, style.px, -1);
}

Rect Canvas::text(const Rect& box, const std::string& markup, const Text& style) {
    if (markup.empty()) return {box.x, box.y, 0, 0};
    PangoLayout* l = surface_->layout.get();
    auto fits = [&](const Rect& e) {
        return pango_layout_get_line_count(l) <= style.lines && e.w <= box.w + 0.5 && e.h <= box.h + 0.5;
    };
    double width = style.lines > 1 ? box.w : -1;
    double px = style.px;
    Rect e = surface_->lay(markup, style, px, width);
    while (!fits(e) && px > style.least_px) {
        px = std::max(style.least_px, px - 0.5);
        e = surface_->lay(markup, style, px, width);
    }
    bool is_cut = false;
    if (!fits(e)) {
        e = surface_->lay(markup, style, px, box.w);
        pango_layout_set_wrap(l, PANGO_WRAP_WORD_CHAR);
        pango_layout_set_ellipsize(l, PANGO_ELLIPSIZE_END);
        pango_layout_set_height(l, -style.lines);
        is_cut = true;
    }
    // Text that exceeds the width by less than half a pixel must not be wrapped.
    pango_layout_set_width(l, static_cast<int>(std::ceil((is_cut ? box.w : std::max(box.w, e.w)) * PANGO_SCALE)));
    PangoRectangle r;
    pango_layout_get_extents(l, nullptr, &r);
    double h = double(r.height) / PANGO_SCALE;
    double y = box.y +
        (style.vertical == Vertical::top             ? 0
                : style.vertical == Vertical::middle ? (box.h - h) / 2
                                                     : box.h - h);
    surface_->ink(style.ink);
    cairo_move_to(surface_->cr, box.x, y);
    if (!text_hidden_) pango_cairo_show_layout(surface_->cr, l);
    Rect extents{box.x + double(r.x) / PANGO_SCALE, y, double(r.width) / PANGO_SCALE, h};
    settings_.push_back({markup, box, extents, px, is_cut, themed(style.ink, theme_)});
    return extents;
}

const unsigned char* Canvas::pixels(int& stride) const {
    cairo_surface_flush(surface_->image);
    stride = cairo_image_surface_get_stride(surface_->image);
    return cairo_image_surface_get_data(surface_->image);
}

std::string Canvas::svg() {
    cairo_surface_finish(surface_->image);
    std::string out = std::move(surface_->document);
    const std::string prefix = "id=\"surface";  // and how many surfaces the process has made
    if (const auto position = out.find(prefix); position != std::string::npos) {
        const auto from = position + prefix.size();
        out.erase(from, out.find_first_not_of("0123456789", from) - from);
    }
    return out;
}

Picture Canvas::picture() const {
    int stride = 0;
    const unsigned char* data = pixels(stride);
    Picture out{width_, height_, std::vector<unsigned char>(3 * std::size_t(width_) * std::size_t(height_))};
    unsigned char* to = out.rgb.data();
    for (int j = 0; j < height_; ++j) {
        for (int i = 0; i < width_; ++i, to += 3) {
            std::uint32_t pixel;
            std::memcpy(&pixel, data + std::ptrdiff_t(j) * stride + std::ptrdiff_t(4) * i, 4);
            to[0] = static_cast<unsigned char>(pixel >> 16);
            to[1] = static_cast<unsigned char>(pixel >> 8);
            to[2] = static_cast<unsigned char>(pixel);
        }
    }
    return out;
}

// ---- The parts of a canvas other than text: shapes by Cairo, blocks of pixels by hand.

void Canvas::fill(const Rect& r, const Colour& c) {
    surface_->ink(c);
    cairo_rectangle(surface_->cr, r.x, r.y, r.w, r.h);
    cairo_fill(surface_->cr);
}

void Canvas::outline(const Rect& r, const Colour& c, double width) {
    surface_->ink(c);
    cairo_set_line_width(surface_->cr, width);
    cairo_rectangle(surface_->cr, r.x, r.y, r.w, r.h);
    cairo_stroke(surface_->cr);
}

void Canvas::line(double x0, double y0, double x1, double y1, const Colour& c, double width, double dash) {
    polyline({{x0, y0}, {x1, y1}}, c, width, dash);
}

void Canvas::polyline(const std::vector<Point>& points, const Colour& c, double width, double dash) {
    if (points.empty()) return;
    cairo_t* cr = surface_->cr;
    surface_->ink(c);
    cairo_set_line_width(cr, width);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    if (dash > 0) cairo_set_dash(cr, &dash, 1, 0);
    cairo_move_to(cr, points[0].x, points[0].y);
    for (const Point& p : points) cairo_line_to(cr, p.x, p.y);
    cairo_stroke(cr);
    cairo_set_dash(cr, nullptr, 0, 0);
}

void Canvas::polygon(const std::vector<Point>& points, const Colour& c) {
    if (points.empty()) return;
    surface_->ink(c);
    cairo_move_to(surface_->cr, points[0].x, points[0].y);
    for (const Point& p : points) cairo_line_to(surface_->cr, p.x, p.y);
    cairo_close_path(surface_->cr);
    cairo_fill(surface_->cr);
}

void Canvas::dot(double x, double y, double radius, const Colour& c) {
    surface_->ink(c);
    cairo_arc(surface_->cr, x, y, radius, 0, 2 * G_PI);
    cairo_fill(surface_->cr);
}

void Canvas::arrow(Point from, Point to, const Colour& c, double width) {
    double dx = to.x - from.x, dy = to.y - from.y, length = math::hypot(dx, dy);
    if (!(length > 0)) return;
    dx /= length;
    dy /= length;
    double head = 4.5 * width, half = 1.7 * width;
    Point neck{to.x - head * dx, to.y - head * dy};
    line(from.x, from.y, neck.x, neck.y, c, width);
    polygon({to, {neck.x - half * dy, neck.y + half * dx}, {neck.x + half * dy, neck.y - half * dx}}, c);
}

void Canvas::paint(const Block& block, int x, int y) {
    ensure(cairo_surface_get_type(surface_->image) == CAIRO_SURFACE_TYPE_IMAGE, "a canvas of pixels takes blocks");
    ensure(x >= 0 && y >= 0 && x + block.width <= width_ && y + block.height <= height_, "a block lies on the canvas");
    cairo_surface_flush(surface_->image);
    unsigned char* data = cairo_image_surface_get_data(surface_->image);
    int stride = cairo_image_surface_get_stride(surface_->image);
    const unsigned char* from = block.rgb.data();
    for (int j = 0; j < block.height; ++j) {
        unsigned char* row = data + std::ptrdiff_t(y + j) * stride + std::ptrdiff_t(4) * x;
        for (int i = 0; i < block.width; ++i, from += 3) {
            std::uint32_t pixel = 0xff000000u | std::uint32_t(from[0]) << 16 | std::uint32_t(from[1]) << 8 | from[2];
            std::memcpy(row + std::ptrdiff_t(4) * i, &pixel, 4);
        }
    }
    cairo_surface_mark_dirty(surface_->image);
    pictures_.push_back({double(x), double(y), double(block.width), double(block.height)});
}

void Canvas::circle(double x, double y, double radius, const Colour& c, double width, double dash) {
    cairo_t* cr = surface_->cr;
    surface_->ink(c);
    cairo_set_line_width(cr, width);
    if (dash > 0) cairo_set_dash(cr, &dash, 1, 0);
    cairo_new_sub_path(cr);
    cairo_arc(cr, x, y, radius, 0, 2 * G_PI);
    cairo_stroke(cr);
    cairo_set_dash(cr, nullptr, 0, 0);
}

void Canvas::clip(const Rect& r) {
    cairo_save(surface_->cr);
    cairo_rectangle(surface_->cr, r.x, r.y, r.w, r.h);
    cairo_clip(surface_->cr);
}

void Canvas::unclip() { cairo_restore(surface_->cr); }

namespace {

// The cells of a row of `cells` cells, each `size` pixels wide from `origin`, that a pixel covers, and their weights,
// whose sum is at most 1.
struct Cover {
    int first = 0, last = -1;
    double from = 0, to = 0;  // in cells
    double share(int cell) const { return std::min(to, cell + 1.0) - std::max(from, double(cell)); }
};

Cover cover(int pixel, double origin, double size, int cells) {
    Cover c;
    c.from = std::max((pixel - origin) / size, 0.0);
    c.to = std::min((pixel + 1 - origin) / size, double(cells));
    c.first = static_cast<int>(c.from + 1e-9);
    c.last = std::min(static_cast<int>(std::ceil(c.to - 1e-9)) - 1, cells - 1);
    return c;
}

std::vector<Cover> covers(int begin, int end, double origin, double size, int cells) {
    std::vector<Cover> list;
    for (int i = begin; i < end; ++i) list.push_back(cover(i, origin, size, cells));
    return list;
}

}  // namespace

void Canvas::paint(const Block& block, double x, double y, int times, double alpha) {
    if (alpha <= 0 || block.width == 0) return;
    const double s = surface_->scale, size = times * s, left_edge = std::round(x * s), top = std::round(y * s);
    const int x0 = std::max(0, static_cast<int>(left_edge)),
              x1 = std::min(width_, static_cast<int>(std::lround(left_edge + block.width * size)));
    const int y0 = std::max(0, static_cast<int>(top)),
              y1 = std::min(height_, static_cast<int>(std::lround(top + block.height * size)));
    cairo_surface_flush(surface_->image);
    unsigned char* data = cairo_image_surface_get_data(surface_->image);
    const int stride = cairo_image_surface_get_stride(surface_->image);
    const std::vector<Cover> column_covers = covers(x0, x1, left_edge, size, block.width);
    for (int j = y0; j < y1; ++j) {
        const Cover row_cover = cover(j, top, size, block.height);
        unsigned char* to = data + std::ptrdiff_t(j) * stride + std::ptrdiff_t(4) * x0;
        for (const Cover& c : column_covers) {
            double sum[3] = {0, 0, 0}, area = 0;
            for (int v = row_cover.first; v <= row_cover.last; ++v) {
                for (int u = c.first; u <= c.last; ++u) {
                    const double share = c.share(u) * row_cover.share(v);
                    const unsigned char* from =
                        &block.rgb[3 * (std::size_t(v) * std::size_t(block.width) + std::size_t(u))];
                    for (int k = 0; k < 3; ++k) sum[k] += share * from[k];
                    area += share;
                }
            }
            for (int k = 0; k < 3 && area > 0; ++k) {  // bytes B, G, R, unused
                unsigned char& byte = to[2 - k];
                byte = static_cast<unsigned char>(alpha * (sum[k] / area) + (1 - alpha) * byte + 0.5);
            }
            to += 4;
        }
    }
    cairo_surface_mark_dirty(surface_->image);
    pictures_.push_back({x, y, double(block.width) * times, double(block.height) * times});
}

// ---- Cairo draws on RGB24 pixels or as SVG into a string; Pango sets Inter unhinted, in grey, glyphs at unrounded
// places, with tabular figures. The family name is queried to check that Inter is installed.

namespace {

constexpr const char* family = "Inter";

struct FreeDescription {
    void operator()(PangoFontDescription* d) const { pango_font_description_free(d); }
};
struct FreeOptions {
    void operator()(cairo_font_options_t* o) const { cairo_font_options_destroy(o); }
};
using Description = std::unique_ptr<PangoFontDescription, FreeDescription>;

Description describe(double px, Weight weight) {
    Description d{pango_font_description_new()};
    pango_font_description_set_family(d.get(), family);
    pango_font_description_set_weight(d.get(), static_cast<PangoWeight>(weight));
    pango_font_description_set_absolute_size(d.get(), px * PANGO_SCALE);
    return d;
}

// Checks the name, because a font map silently returns another family, or ends the program if it has none at all.
void require_font(PangoFontMap* map) {
    PangoFontFamily** families = nullptr;
    int count = 0;
    pango_font_map_list_families(map, &families, &count);
    bool has_font = false;
    for (int i = 0; i < count; ++i) has_font |= std::strcmp(pango_font_family_get_name(families[i]), family) == 0;
    g_free(families);
    if (!has_font) {
        throw OutputError(std::string("plates are set in the font ") + family +
            ", which this machine does not have: install the package fonts-inter");
    }
}

void replace_all(std::string& text, std::string_view what, const std::string& replacement) {
    for (auto position = text.find(what); position != std::string::npos;
        position = text.find(what, position + replacement.size())) {
        text.replace(position, what.size(), replacement);
    }
}

// Sets <sup> and <sub> as plain spans of a size and a rise, because Pango's own forms keep their scale when text is
// ellipsized within them. Tabular figures throughout.
std::string spans(std::string markup, double px) {
    auto open = [&](double rise) {
        return fmt::format("<span size='70%' rise='{}'>", std::lround(rise * px * PANGO_SCALE));
    };
    replace_all(markup, "<sup>", open(0.36));
    replace_all(markup, "<sub>", open(-0.16));
    replace_all(markup, "</sup>", "</span>");
    replace_all(markup, "</sub>", "</span>");
    return "<span font_features='tnum=1'>" + markup + "</span>";
}

PangoAlignment to_pango(Align a) {
    return a == Align::left ? PANGO_ALIGN_LEFT : a == Align::right ? PANGO_ALIGN_RIGHT : PANGO_ALIGN_CENTER;
}

cairo_status_t append(void* document, const unsigned char* bytes, unsigned int count) {
    static_cast<std::string*>(document)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
}

}  // namespace

Canvas::Surface::Surface(int width, int height, double pixels_a_unit, Theme colours, Medium medium)
    : scale(pixels_a_unit), theme(colours) {
    use_fonts_beside_program();
    require_font(pango_cairo_font_map_get_default());
    image = medium == Medium::svg ? cairo_svg_surface_create_for_stream(append, &document, width, height)
                                  : cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    if (medium == Medium::svg) cairo_svg_surface_set_document_unit(image, CAIRO_SVG_UNIT_PX);
    cr = cairo_create(image);
    cairo_scale(cr, scale, scale);
    layout.reset(pango_cairo_create_layout(cr));
    PangoContext* context = pango_layout_get_context(layout.get());
    // Grey antialiasing and no hinting: the same outlines with all desktop settings.
    std::unique_ptr<cairo_font_options_t, FreeOptions> options{cairo_font_options_create()};
    cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(context, options.get());
    pango_cairo_context_set_resolution(context, 96);
    pango_context_set_round_glyph_positions(context, FALSE);
    pango_context_set_language(context, pango_language_from_string("en"));
}
void Canvas::Surface::ink(const Colour& c) {
    const Colour shade = themed(c, theme);
    cairo_set_source_rgba(cr, shade.r, shade.g, shade.b, shade.a);
}

Canvas::Surface::~Surface() {
    layout.reset();
    cairo_destroy(cr);
    cairo_surface_destroy(image);
}

Rect Canvas::Surface::lay(const std::string& markup, const Text& style, double px, double width) {
    PangoLayout* l = layout.get();
    pango_layout_set_font_description(l, describe(px, style.weight).get());
    pango_layout_set_ellipsize(l, PANGO_ELLIPSIZE_NONE);
    pango_layout_set_height(l, -1);
    pango_layout_set_width(l, width < 0 ? -1 : static_cast<int>(std::ceil(width * PANGO_SCALE)));
    pango_layout_set_wrap(l, PANGO_WRAP_WORD);
    pango_layout_set_alignment(l, to_pango(style.align));
    pango_layout_set_line_spacing(l, style.lines > 1 ? 1.12f : 0.0f);
    std::string text = spans(markup, px);
    pango_layout_set_markup(l, text.c_str(), static_cast<int>(text.size()));
    PangoRectangle r;
    pango_layout_get_extents(l, nullptr, &r);
    return {double(r.x) / PANGO_SCALE, double(r.y) / PANGO_SCALE, double(r.width) / PANGO_SCALE,
        double(r.height) / PANGO_SCALE};
}

}  // namespace crescent::plates
