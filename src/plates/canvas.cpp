#include "plates/canvas.h"

#include <fmt/format.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/errors.h"

namespace crescent::plates {

namespace {

constexpr const char* family = "Inter";

struct Unref {
    void operator()(gpointer object) const { g_object_unref(object); }
};
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

// Asks by name: a font map hands out another family in silence, or ends the program where it has none at all.
void require_font(PangoFontMap* map) {
    PangoFontFamily** families = nullptr;
    int count = 0;
    pango_font_map_list_families(map, &families, &count);
    bool found = false;
    for (int i = 0; i < count; ++i) found |= std::strcmp(pango_font_family_get_name(families[i]), family) == 0;
    g_free(families);
    if (!found) {
        throw OutputError(std::string("plates are set in the font ") + family +
                          ", which this machine does not have: install the package fonts-inter");
    }
}

void replace_all(std::string& text, std::string_view what, const std::string& by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
        text.replace(at, what.size(), by);
    }
}

// <sup> and <sub> as plain spans of a size and a rise: Pango's own forms leave their scale behind when text is
// ellipsized within them. Tabular figures throughout.
std::string spans(std::string markup, double px) {
    auto open = [&](double rise) { return fmt::format("<span size='70%' rise='{}'>", std::lround(rise * px * PANGO_SCALE)); };
    replace_all(markup, "<sup>", open(0.36));
    replace_all(markup, "<sub>", open(-0.16));
    replace_all(markup, "</sup>", "</span>");
    replace_all(markup, "</sub>", "</span>");
    return "<span font_features='tnum=1'>" + markup + "</span>";
}

PangoAlignment to_pango(Align a) {
    return a == Align::left ? PANGO_ALIGN_LEFT : a == Align::right ? PANGO_ALIGN_RIGHT : PANGO_ALIGN_CENTER;
}

}  // namespace

Colour colour(const Srgb8& c) { return {c[0] / 255.0, c[1] / 255.0, c[2] / 255.0, 1}; }

std::string escaped(std::string_view plain) {
    std::unique_ptr<char, decltype(&g_free)> text{g_markup_escape_text(plain.data(), gssize(plain.size())), g_free};
    return text.get();
}

struct Canvas::Surface {
    cairo_surface_t* image = nullptr;
    cairo_t* cr = nullptr;
    std::unique_ptr<PangoLayout, Unref> layout;

    Surface(int width, int height) {
        require_font(pango_cairo_font_map_get_default());
        image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
        cr = cairo_create(image);
        layout.reset(pango_cairo_create_layout(cr));
        PangoContext* context = pango_layout_get_context(layout.get());
        // Grey antialiasing and no hinting: the same outlines whatever the desktop's settings are.
        std::unique_ptr<cairo_font_options_t, FreeOptions> options{cairo_font_options_create()};
        cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
        cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
        cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
        pango_cairo_context_set_font_options(context, options.get());
        pango_cairo_context_set_resolution(context, 96);
        pango_context_set_round_glyph_positions(context, FALSE);
        pango_context_set_language(context, pango_language_from_string("en"));
    }
    ~Surface() {
        layout.reset();
        cairo_destroy(cr);
        cairo_surface_destroy(image);
    }
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    void ink(const Colour& c) { cairo_set_source_rgba(cr, c.r, c.g, c.b, c.a); }

    // Lays markup out at `px`; width < 0: unbounded.
    Rect lay(const std::string& markup, const Text& how, double px, double width) {
        PangoLayout* l = layout.get();
        pango_layout_set_font_description(l, describe(px, how.weight).get());
        pango_layout_set_ellipsize(l, PANGO_ELLIPSIZE_NONE);
        pango_layout_set_height(l, -1);
        pango_layout_set_width(l, width < 0 ? -1 : static_cast<int>(std::ceil(width * PANGO_SCALE)));
        pango_layout_set_wrap(l, PANGO_WRAP_WORD);
        pango_layout_set_alignment(l, to_pango(how.align));
        pango_layout_set_line_spacing(l, how.lines > 1 ? 1.12f : 0.0f);
        std::string text = spans(markup, px);
        pango_layout_set_markup(l, text.c_str(), static_cast<int>(text.size()));
        PangoRectangle r;
        pango_layout_get_extents(l, nullptr, &r);
        return {double(r.x) / PANGO_SCALE, double(r.y) / PANGO_SCALE, double(r.width) / PANGO_SCALE,
                double(r.height) / PANGO_SCALE};
    }
};

Canvas::Canvas(int width, int height, const Colour& ground)
    : width_(width), height_(height), surface_(std::make_unique<Surface>(width, height)) {
    surface_->ink(ground);
    cairo_paint(surface_->cr);
}

Canvas::~Canvas() = default;

Rect Canvas::measure(const std::string& markup, const Text& how) const {
    Text one = how;
    one.lines = 1;
    return surface_->lay(markup, one, how.px, -1);
}

Rect Canvas::text(const Rect& box, const std::string& markup, const Text& how) {
    if (markup.empty()) return {box.x, box.y, 0, 0};
    PangoLayout* l = surface_->layout.get();
    auto fits = [&](const Rect& e) {
        return pango_layout_get_line_count(l) <= how.lines && e.w <= box.w + 0.5 && e.h <= box.h + 0.5;
    };
    double width = how.lines > 1 ? box.w : -1;
    double px = how.px;
    Rect e = surface_->lay(markup, how, px, width);
    while (!fits(e) && px > how.least) {
        px = std::max(how.least, px - 0.5);
        e = surface_->lay(markup, how, px, width);
    }
    bool cut = false;
    if (!fits(e)) {
        e = surface_->lay(markup, how, px, box.w);
        pango_layout_set_wrap(l, PANGO_WRAP_WORD_CHAR);
        pango_layout_set_ellipsize(l, PANGO_ELLIPSIZE_END);
        pango_layout_set_height(l, -how.lines);
        cut = true;
    }
    pango_layout_set_width(l, static_cast<int>(std::ceil(box.w * PANGO_SCALE)));
    PangoRectangle r;
    pango_layout_get_extents(l, nullptr, &r);
    double h = double(r.height) / PANGO_SCALE;
    double y = box.y + (how.vertical == Vertical::top ? 0 : how.vertical == Vertical::middle ? (box.h - h) / 2 : box.h - h);
    surface_->ink(how.ink);
    cairo_move_to(surface_->cr, box.x, y);
    pango_cairo_show_layout(surface_->cr, l);
    Rect took{box.x + double(r.x) / PANGO_SCALE, y, double(r.width) / PANGO_SCALE, h};
    settings_.push_back({markup, box, took, px, cut});
    return took;
}

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
    double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
    if (!(length > 0)) return;
    dx /= length, dy /= length;
    double head = 4.5 * width, half = 1.7 * width;
    Point neck{to.x - head * dx, to.y - head * dy};
    line(from.x, from.y, neck.x, neck.y, c, width);
    polygon({to, {neck.x - half * dy, neck.y + half * dx}, {neck.x + half * dy, neck.y - half * dx}}, c);
}

void Canvas::paint(const Block& block, int x, int y) {
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

Picture Canvas::picture() const {
    cairo_surface_flush(surface_->image);
    const unsigned char* data = cairo_image_surface_get_data(surface_->image);
    int stride = cairo_image_surface_get_stride(surface_->image);
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

}  // namespace crescent::plates
