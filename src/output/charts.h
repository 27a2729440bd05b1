// Charts as inline SVG: lines, dots, bands and bars between two axes. Sizes in CSS pixels of an unscaled chart; the
// chart scales with the page. Colours are classes of the page's style sheet (c0, c1, ...), so that they follow light
// and dark. Points that are not finite, or not positive on a log axis, are not drawn.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace crescent::inline output {

// ---- Axes of charts, whatever draws them (SVG in pages, Cairo on plates and in the film): what they span, where their
// ticks are, where a value lies, and how names beside a chart are kept apart. No lengths in pixels but those of the
// caller.

/// What an axis spans, and where its ticks are.
struct Axis {
    double low = 0, high = 1;  // data at the two ends
    bool log = false;
    std::string label = {};  // plain text
    std::vector<double> ticks = {};

    /// Where x lies on the axis: 0 at low, 1 at high; what a log axis cannot hold, at low.
    double share(double x) const;
    /// Whether x has a place: it is finite, and above 0 on a log axis.
    bool can_hold(double x) const;
};

/// An axis that holds all values and ends at ticks a round step apart. Values that are not finite are passed over;
/// values that are all alike still get an axis of some length.
Axis linear_axis(std::string label, const std::vector<double>& values);
/// A logarithmic axis from the least value / `wider` to the largest x `wider`; only positive finite values count.
Axis log_axis(std::string label, const std::vector<double>& values, double wider = 1.25);

/// Round numbers from `low` to `high`, both above 0: the more decades they span, the fewer a decade. At least one where
/// high / low is 1.4 or more.
std::vector<double> log_ticks(double low, double high);

/// The smallest of `leads` times a power of ten that is `least` (above 0) or more. Leads rise from 1 to below 10.
double round_up(double least, std::initializer_list<double> leads = {1, 2, 5});

/// Places of names along a side, in the order given: pushed up to be `pitch` apart and from `first` on, then down so
/// that none is above `last`.
std::vector<double> moved_apart(const std::vector<double>& places, double pitch, double first, double last);

/// In data coordinates.
struct Point {
    double x = 0, y = 0;
};

/// A chart as inline SVG, drawn in the order of the calls. `css`: classes of the report's style sheet. Points that a
/// log axis cannot hold, and NaN, are left out.
class Chart {
public:
    /// `title` is read out in place of the picture.
    Chart(int width, int height, Axis x, Axis y, std::string title);

    /// A line through the points, dots or diamonds at them.
    void line(const std::vector<Point>& points, std::string_view css);
    void dots(const std::vector<Point>& points, std::string_view css);
    void diamonds(const std::vector<Point>& points, std::string_view css);
    /// The area between two curves over the same x.
    void band(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high,
        std::string_view css);
    /// A vertical bar with caps, as for an interval.
    void bar(double x, double low, double high, std::string_view css);
    /// A horizontal line at y, named at its right end inside the frame.
    void rule(double y, std::string_view css, std::string_view name);
    /// Words at a data point, shifted right by a few pixels; for the end of a line. Names that would overlap move
    /// apart.
    void name(Point at, std::string_view text, std::string_view css);
    std::string str() const;

private:
    double px(double x) const;
    double py(double y) const;
    bool drawable(double x, double y) const { return x_.can_hold(x) && y_.can_hold(y); }
    std::string axes() const;
    std::string framed() const;
    std::string names() const;

    int width_, height_;
    Axis x_, y_;
    std::string title_, inside_, body_;  // inside_ is cut off at the frame
    struct Name {
        double x = 0, y = 0;
        std::string text, css;
    };
    std::vector<Name> names_;
};

/// A strip: 5-95 % as a bar, the median as a tick, the measured value as a dot, the published one as a diamond.
struct Strip {
    double q05 = 0, median = 0, q95 = 0, measured = 0;
    bool bar = true;  // false: no interval (heavy tail)
    bool has_published = false;
    double published = 0;
};
/// A band as a strip with its median: <svg>.
std::string strip_svg(const Strip& strip);

}  // namespace crescent::inline output
