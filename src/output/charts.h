// Charts as inline SVG: lines, dots, bands and bars between two axes. Sizes in CSS pixels of an unscaled chart; the
// chart scales with the page. Colours are classes of the page's style sheet (c0, c1, ...), so that they follow light
// and dark themes. Points that are not finite, or not positive on a log axis, are not drawn.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace crescent {

// ---- Axes of charts for all renderers (SVG in pages, Cairo on plates and in the video): their range, their ticks, the
// place of a value, and the separation of names next to a chart; all lengths in pixels come from the caller.

/// The range of an axis, and its ticks.
struct Axis {
    double low = 0, high = 1;  // data at the two ends
    bool log = false;
    std::string label = {};  // plain text
    std::vector<double> ticks = {};

    /// Returns the place of x on the axis: 0 at low, 1 at high; values that a log axis cannot show, at low.
    double share(double x) const;
    /// Returns whether x can be shown: it is finite, and above 0 on a log axis.
    bool can_hold(double x) const;
};

/// Returns an axis that contains all values and ends at ticks a round step apart. Values that are not finite are
/// ignored; equal values still give an axis of positive length.
Axis linear_axis(std::string label, const std::vector<double>& values);
/// Returns a logarithmic axis from the smallest value / `factor` to the largest x `factor`; only positive finite values
/// count.
Axis log_axis(std::string label, const std::vector<double>& values, double factor = 1.25);

/// Returns round numbers from `low` to `high`, both above 0: the more decades, the fewer per decade. At least one if
/// high / low is 1.4 or more.
std::vector<double> log_ticks(double low, double high);

/// Returns the smallest of `leads` times a power of ten that is at least `value` (above 0). Leads ascend from 1 to
/// below 10.
double round_up(double value, std::initializer_list<double> leads = {1, 2, 5});

/// Returns places of names along a side, in the order given: moved up to be `pitch` apart and from `first` on, then
/// down so that none is above `last`.
std::vector<double> moved_apart(const std::vector<double>& places, double pitch, double first, double last);

/// In data coordinates.
struct Point {
    double x = 0, y = 0;
};

/// A chart as inline SVG, drawn in the order of the calls. `css`: classes of the report's style sheet. Points that a
/// log axis cannot show, and NaN, are omitted.
class Chart {
public:
    /// `title` is the text for screen readers.
    Chart(int width, int height, Axis x, Axis y, std::string title);

    /// Draws a line through the points, dots or diamonds at them.
    void line(const std::vector<Point>& points, std::string_view css);
    void dots(const std::vector<Point>& points, std::string_view css);
    void diamonds(const std::vector<Point>& points, std::string_view css);
    /// Draws the area between two curves over the same x.
    void band(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high,
        std::string_view css);
    /// Draws a vertical bar with caps, for an interval.
    void bar(double x, double low, double high, std::string_view css);
    /// Draws a horizontal line at y, with its name at the right end inside the frame.
    void rule(double y, std::string_view css, std::string_view name);
    /// Draws words at a data point, shifted right by a few pixels; for the end of a line. Names that would overlap are
    /// moved apart.
    void name(Point point, std::string_view text, std::string_view css);
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
    std::string title_, frame_content_, body_;  // frame_content_ is clipped at the frame
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

}  // namespace crescent
