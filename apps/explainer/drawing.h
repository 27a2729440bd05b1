// Shared by several shots: outlines of regions on pictures, residuals, a logarithmic plot.
#pragma once

#include <string>
#include <vector>

#include "data.h"
#include "frame.h"

namespace crescent::explainer {

// ---- Type sizes and colours of the video, in units of the 1920 x 1080 sheet: no text below 27, which is 9 pixels on a
// phone at 640 x 360.

using plates::alert;
using plates::backend_accent;
using plates::bright;
using plates::ground;
using plates::muted;
using plates::panel;
using plates::photograph_accent;
using plates::rule;
using plates::with;
using plates::with_lines;
using plates::with_px;

/// The two regions, different from every arm.
inline constexpr Colour highlight_ink = plates::series[3], surround_ink = plates::series[4];

inline constexpr double least_px = 27;
inline constexpr Text big_text{.px = 96, .ink = bright, .weight = Weight::semibold, .least_px = 40};
inline constexpr Text title_text{
    .px = 40, .ink = bright, .weight = Weight::semibold, .vertical = Vertical::middle, .least_px = 30};
inline constexpr Text caption_text{.px = 44,
    .ink = bright,
    .weight = Weight::medium,
    .align = Align::centre,
    .vertical = Vertical::middle,
    .lines = 2,
    .least_px = 34};
inline constexpr Text label_text{
    .px = 36, .ink = bright, .weight = Weight::medium, .vertical = Vertical::middle, .least_px = 28};
inline constexpr Text body_text{.px = 32, .ink = bright, .least_px = least_px};
inline constexpr Text small_text{.px = 28, .ink = muted, .vertical = Vertical::middle, .least_px = least_px};
inline constexpr Text number_text{.px = 56,
    .ink = bright,
    .weight = Weight::semibold,
    .align = Align::centre,
    .vertical = Vertical::middle,
    .least_px = 34};

/// A part of the image that fills a slot as far as whole-number enlargement permits.
struct Closeup {
    Box box;
    int times = 1;
};
/// Returns the part around `box`; with `margin` times its sides it fits the slot, if possible.
Closeup close_up(const Data& data, const Box& box, const Rect& slot, double margin);
/// Returns the whole image, or the part around the highlight that fits if it is larger than the slot.
Closeup whole_or_part(const Data& data, const Rect& slot);
/// Paints the block at the centre-top of the slot.
Rect show(Frame& f, const Block& block, int times, const Rect& slot, double alpha = 1);
/// Returns where image box `box` lies on a picture `r` that shows `visible_box`.
Rect on_picture(const Rect& r, const Box& visible_box, const Box& box);
/// Draws an outline that is visible on light and on dark.
void mark(Frame& f, const Rect& r, Colour ink, double alpha = 1);
/// Draws words on a tag, so that they are readable on a picture; `corner` is its bottom-left corner.
void tag(Frame& f, Point corner, const Words& words, Colour ink, double alpha = 1);

/// Returns |Y - Y_ref| of a box in turbo colours, 0 .. top.
Block residual_of(const Film& film, const ReferenceFilm& reference, const Box& box, double top);
std::vector<double> residuals(const Film& film, const ReferenceFilm& reference, const Box& box);

/// Both axes logarithmic.
struct LogPlot {
    Rect plot;
    double x0 = 1, x1 = 10, y0 = 1, y1 = 10;
    Point at(double x, double y) const;
    /// Frame lines, powers of ten on the left, the given values below.
    void axes(Frame& f, const std::vector<std::uint64_t>& x_ticks, const Words& x_name, const Words& y_name,
        double alpha) const;
};

/// Returns the polyline up to `part` of its length, 0 .. 1.
std::vector<Point> begun(const std::vector<Point>& path, double part);

/// Returns columns of equal width over the stage.
Rect column_of(double x, double w, double gap, std::size_t k);

/// "6.18, Cosine by" .. the arm with the lower RMSE in a region, and the other; if equal, a comes first.
struct Order {
    RunKey low, high;
    double low_value = 0, high_value = 0;
};
Order order_of(const Data& data, const RunKey& a, const RunKey& b, const std::string& region);

// ---- Axes of a chart: a box on the sheet, each side linear or logarithmic, with ticks whose labels are numbers.

/// A tick on an axis and its label, which may be empty.
struct Tick {
    double position = 0;
    Words words;
};
/// Returns powers of ten on the axis, every `step`-th of them.
std::vector<Tick> decades(const Axis& scale, int step = 1);
/// Returns round values, at most `limit` of them.
std::vector<Tick> round_values(const Axis& scale, int limit);
/// Returns ticks at exactly these positions.
std::vector<Tick> values(const std::vector<double>& positions, int digits);

struct Axes {
    Rect box;
    Axis horizontal, vertical;

    double x(double v) const { return box.x + box.w * horizontal.share(v); }
    double y(double v) const { return box.bottom() - box.h * vertical.share(v); }
    Point at(double vx, double vy) const { return {x(vx), y(vy)}; }

    /// Draws the two axes with their ticks, labels left and below, and titles: above the vertical axis, below the
    /// horizontal one.
    void draw(Frame& f, const std::vector<Tick>& x_ticks, const std::vector<Tick>& y_ticks, const Words& x_name,
        const Words& y_name, double alpha = 1) const;
};

}  // namespace crescent::explainer
