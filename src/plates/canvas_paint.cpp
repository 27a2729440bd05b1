// What a canvas draws that is not text: shapes by Cairo, blocks of pixels by hand.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/errors.h"
#include "math/functions.h"
#include "plates/canvas_surface.h"

namespace crescent::plates {

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
    dx /= length, dy /= length;
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

// Which cells of a row of `cells` cells, each `size` pixels wide from `origin`, a pixel covers, and with what weight:
// the cells' shares add to at most 1.
struct Cover {
    int first = 0, last = -1;
    double from = 0, to = 0;  // in cells
    double share(int cell) const { return std::min(to, cell + 1.0) - std::max(from, double(cell)); }
};

Cover cover(int pixel, double origin, double size, int cells) {
    Cover c;
    c.from = std::max((pixel - origin) / size, 0.0), c.to = std::min((pixel + 1 - origin) / size, double(cells));
    c.first = static_cast<int>(c.from + 1e-9);
    c.last = std::min(static_cast<int>(std::ceil(c.to - 1e-9)) - 1, cells - 1);
    return c;
}

std::vector<Cover> covers(int begin, int end, double origin, double size, int cells) {
    std::vector<Cover> all;
    for (int i = begin; i < end; ++i) all.push_back(cover(i, origin, size, cells));
    return all;
}

}  // namespace

void Canvas::paint(const Block& block, double x, double y, int times, double alpha) {
    if (alpha <= 0 || block.width == 0) return;
    const double s = surface_->scale, size = times * s, left = std::round(x * s), top = std::round(y * s);
    const int x0 = std::max(0, static_cast<int>(left)),
              x1 = std::min(width_, static_cast<int>(std::lround(left + block.width * size)));
    const int y0 = std::max(0, static_cast<int>(top)),
              y1 = std::min(height_, static_cast<int>(std::lround(top + block.height * size)));
    cairo_surface_flush(surface_->image);
    unsigned char* data = cairo_image_surface_get_data(surface_->image);
    const int stride = cairo_image_surface_get_stride(surface_->image);
    const std::vector<Cover> across = covers(x0, x1, left, size, block.width);
    for (int j = y0; j < y1; ++j) {
        const Cover down = cover(j, top, size, block.height);
        unsigned char* to = data + std::ptrdiff_t(j) * stride + std::ptrdiff_t(4) * x0;
        for (const Cover& c : across) {
            double sum[3] = {0, 0, 0}, area = 0;
            for (int v = down.first; v <= down.last; ++v) {
                for (int u = c.first; u <= c.last; ++u) {
                    const double share = c.share(u) * down.share(v);
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

}  // namespace crescent::plates
