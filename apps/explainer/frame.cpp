// Each query of a shot for the time is stored with its result; a frame at another time is equal if every result is.
// Shapes and words are drawn with the alpha of their colour scaled, and not at all at 0.
#include "frame.h"

#include <algorithm>
#include <cmath>

namespace crescent::explainer {

namespace {

Colour faded(Colour c, double alpha) { return c.a *= alpha, c; }

}  // namespace

double Frame::evaluate(const TimeQuery& q, double t) {
    const double x = q.to > q.from ? std::clamp((t - q.from) / (q.to - q.from), 0.0, 1.0) : double(t >= q.from);
    switch (q.kind) {
        case Kind::ramp: return x;
        case Kind::ease: return x * x * (3 - 2 * x);
        case Kind::after: return t >= q.from;
        case Kind::steps: return t >= q.to ? q.n : std::floor(x * q.n);
    }
    return 0;
}

double Frame::query(TimeQuery q) {
    q.result = evaluate(q, t_);
    queries_.push_back(q);
    return q.result;
}

bool Frame::same_at(double t) const {
    return std::all_of(
        queries_.begin(), queries_.end(), [t](const TimeQuery& q) { return evaluate(q, t) == q.result; });
}

Rect Frame::text(const Rect& box, const Words& words, Text style, double alpha) {
    if (alpha <= 0) return {box.x, box.y, 0, 0};
    style.ink = faded(style.ink, alpha);
    texts_.push_back(words);
    return canvas_.text(box, words.markup(), style);
}

Rect Frame::field(const Block& block, double x, double y, int times, double alpha) {
    const Rect r{std::round(x), std::round(y), double(block.width) * times, double(block.height) * times};
    canvas_.paint(block, r.x, r.y, times, alpha);
    return r;
}

Rect Frame::picture(const Block& block, double x, double y, int times, double alpha) {
    const Rect r = field(block, x, y, times, alpha);
    if (alpha > 0) canvas_.outline(r.inset(-1), faded(plates::rule, alpha), 2);
    return r;
}

void Frame::field(const Block& block, Point corner, double alpha) {
    canvas_.paint(block, std::round(corner.x), std::round(corner.y), 1, alpha);
}

void Frame::fill(const Rect& r, Colour c, double alpha) {
    if (alpha > 0) canvas_.fill(r, faded(c, alpha));
}
void Frame::outline(const Rect& r, Colour c, double line, double alpha) {
    if (alpha > 0) canvas_.outline(r, faded(c, alpha), line);
}
void Frame::line(Point a, Point b, Colour c, double line, double alpha, double dash) {
    if (alpha > 0) canvas_.line(a.x, a.y, b.x, b.y, faded(c, alpha), line, dash);
}
void Frame::polyline(const std::vector<Point>& points, Colour c, double line, double alpha, double dash) {
    if (alpha > 0) canvas_.polyline(points, faded(c, alpha), line, dash);
}
void Frame::polygon(const std::vector<Point>& points, Colour c, double alpha) {
    if (alpha > 0) canvas_.polygon(points, faded(c, alpha));
}
void Frame::dot(Point centre, double radius, Colour c, double alpha) {
    if (alpha > 0) canvas_.dot(centre.x, centre.y, radius, faded(c, alpha));
}
void Frame::circle(Point centre, double radius, Colour c, double line, double alpha, double dash) {
    if (alpha > 0) canvas_.circle(centre.x, centre.y, radius, faded(c, alpha), line, dash);
}
void Frame::arrow(Point from, Point to, Colour c, double line, double alpha) {
    if (alpha > 0) canvas_.arrow(from, to, faded(c, alpha), line);
}

}  // namespace crescent::explainer
