// One frame being drawn, on a sheet of 1920 x 1080 units. A shot queries the time only through ramp, ease, after and
// count, so that equal frames are recognised without being drawn.
#pragma once

#include <vector>

#include "crescent/crescent.h"
#include "words.h"

namespace crescent::explainer {

using plates::Align;
using plates::Block;
using plates::Canvas;
using plates::Colour;
using plates::Rect;
using plates::Text;
using plates::Vertical;
using plates::Weight;
using Point = plates::Canvas::Point;

inline constexpr double sheet_width = 1920, sheet_height = 1080;
/// Pictures, charts and formulas are on the stage; the engine draws the caption's band below it.
inline constexpr Rect heading_band{60, 36, 1800, 56};
inline constexpr Rect stage{60, 116, 1800, 774};
inline constexpr Rect caption_band{160, 912, 1600, 140};

class Frame {
public:
    /// `t`: seconds from the shot's beginning.
    Frame(Canvas& canvas, double t) : canvas_(canvas), t_(t) {}

    /// Returns 0 until `from`, 1 from `to` on, linear between.
    double ramp(double from, double to) { return query({Kind::ramp, from, to}); }
    /// The same with a smooth start and end: 3x^2 - 2x^3.
    double ease(double from, double to) { return query({Kind::ease, from, to}); }
    bool after(double time) { return query({Kind::after, time, time}) > 0; }
    /// Returns 1 between the two, eased over `fade` seconds on either side.
    double during(double from, double to, double fade = 0.4) {
        return ease(from - fade, from) * (1 - ease(to, to + fade));
    }
    /// Returns 0 .. n: how many of n equal steps from `from` to `to` are complete.
    int steps(double from, double to, int n) {
        return static_cast<int>(query({.kind = Kind::steps, .from = from, .to = to, .n = n}));
    }

    /// Sets words in a box; For `alpha` 0 nothing is drawn. Returns their extents.
    Rect text(const Rect& box, const Words& words, Text style, double alpha = 1);
    Rect measure(const Words& words, const Text& style) { return canvas_.measure(words.markup(), style); }
    /// Paints a block of pixels enlarged `times` times, its corner at whole units, with a hairline around it.
    Rect picture(const Block& block, double x, double y, int times, double alpha = 1);
    /// The same one to one without the hairline, for a block whose edge is the ground.
    void field(const Block& block, Point corner, double alpha = 1);
    /// The same without the hairline.
    Rect field(const Block& block, double x, double y, int times, double alpha = 1);
    void fill(const Rect& r, Colour c, double alpha = 1);
    void outline(const Rect& r, Colour c, double line, double alpha = 1);
    void line(Point a, Point b, Colour c, double line, double alpha = 1, double dash = 0);
    void polyline(const std::vector<Point>& points, Colour c, double line, double alpha = 1, double dash = 0);
    void polygon(const std::vector<Point>& points, Colour c, double alpha = 1);
    void dot(Point centre, double radius, Colour c, double alpha = 1);
    void circle(Point centre, double radius, Colour c, double line, double alpha = 1, double dash = 0);
    void arrow(Point from, Point to, Colour c, double line, double alpha = 1);
    void clip(const Rect& r) { canvas_.clip(r); }
    void unclip() { canvas_.unclip(); }

    /// Returns whether a frame of the same shot at `t` would be equal.
    bool same_at(double t) const;
    /// Returns the words set, in order: for tests.
    const std::vector<Words>& texts() const { return texts_; }

private:
    enum class Kind { ramp, ease, after, steps };
    struct TimeQuery {
        Kind kind;
        double from, to;
        int n = 0;
        double result = 0;
    };
    static double evaluate(const TimeQuery& q, double t);
    double query(TimeQuery q);

    Canvas& canvas_;
    double t_;
    std::vector<TimeQuery> queries_;
    std::vector<Words> texts_;
};

}  // namespace crescent::explainer
