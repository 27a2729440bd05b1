// Pango sets text at its size, then half a pixel smaller each time until it fits its box; at the least size it is
// ellipsized. What was set, where and how large is noted. Pictures are copied out of Cairo's 32-bit pixels.
#include "plates/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "plates/canvas_surface.h"
#include "plates/style.h"

namespace crescent::plates {

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
    cairo_set_line_join(surface_->cr, CAIRO_LINE_JOIN_MITER);  // polylines leave theirs behind
    cairo_paint(surface_->cr);
    settings_.clear();
    pictures_.clear();
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
    // What fits within half a pixel must not be wrapped for that half.
    pango_layout_set_width(l, static_cast<int>(std::ceil((cut ? box.w : std::max(box.w, e.w)) * PANGO_SCALE)));
    PangoRectangle r;
    pango_layout_get_extents(l, nullptr, &r);
    double h = double(r.height) / PANGO_SCALE;
    double y = box.y +
        (how.vertical == Vertical::top             ? 0
                : how.vertical == Vertical::middle ? (box.h - h) / 2
                                                   : box.h - h);
    surface_->ink(how.ink);
    cairo_move_to(surface_->cr, box.x, y);
    if (!text_hidden_) pango_cairo_show_layout(surface_->cr, l);
    Rect took{box.x + double(r.x) / PANGO_SCALE, y, double(r.width) / PANGO_SCALE, h};
    settings_.push_back({markup, box, took, px, cut, themed(how.ink, theme_)});
    return took;
}

const unsigned char* Canvas::pixels(int& stride) const {
    cairo_surface_flush(surface_->image);
    stride = cairo_image_surface_get_stride(surface_->image);
    return cairo_image_surface_get_data(surface_->image);
}

std::string Canvas::svg() {
    cairo_surface_finish(surface_->image);
    std::string out = std::move(surface_->document);
    const std::string counted = "id=\"surface";  // and how many surfaces the process has made
    if (const auto at = out.find(counted); at != std::string::npos) {
        const auto from = at + counted.size();
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

}  // namespace crescent::plates
