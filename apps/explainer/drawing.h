// What several shots draw: outlines of regions on pictures, residuals, a logarithmic plot.
#pragma once

#include <string>
#include <vector>

#include "data.h"
#include "frame.h"

namespace crescent::explainer {

// ---- Type and inks of the film, in units of the 1920 x 1080 sheet: no text under 27, which is 9 pixels on a phone at
// 640 x 360.

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

/// The two regions, told apart from every arm.
inline constexpr Colour highlight_ink = plates::series[3], surround_ink = plates::series[4];

inline constexpr double least_px = 27;
inline constexpr Text big_text{96, bright, Weight::semibold, Align::left, Vertical::top, 1, 40};
inline constexpr Text title_text{40, bright, Weight::semibold, Align::left, Vertical::middle, 1, 30};
inline constexpr Text caption_text{44, bright, Weight::medium, Align::centre, Vertical::middle, 2, 34};
inline constexpr Text label_text{36, bright, Weight::medium, Align::left, Vertical::middle, 1, 28};
inline constexpr Text body_text{32, bright, Weight::regular, Align::left, Vertical::top, 1, least_px};
inline constexpr Text small_text{28, muted, Weight::regular, Align::left, Vertical::middle, 1, least_px};
inline constexpr Text number_text{56, bright, Weight::semibold, Align::centre, Vertical::middle, 1, 34};

/// Part of the image that fills a slot as well as whole-number enlargement allows.
struct Closeup {
    Box box;
    int times = 1;
};
/// Around `of`, which with `margin` times its sides fits the slot where anything does.
Closeup close_up(const Data& data, const Box& of, const Rect& slot, double margin);
/// The whole image; what fits of it around the highlight where it is larger than the slot.
Closeup whole_or_part(const Data& data, const Rect& slot);
/// Paints the block in the middle of the slot's top.
Rect show(Frame& f, const Block& block, int times, const Rect& slot, double alpha = 1);
/// Where image box `box` lies on a picture `r` that shows `shown`.
Rect on_picture(const Rect& r, const Box& shown, const Box& box);
/// An outline that shows on light and on dark.
void mark(Frame& f, const Rect& r, Colour ink, double alpha = 1);
/// Words on a tag of their own, so that they can be read on a picture; its bottom-left corner.
void tag(Frame& f, Point at, const Words& words, Colour ink, double alpha = 1);

/// |Y - Y_ref| of a box through turbo, 0 .. top.
Block residual_of(const Film& film, const ReferenceFilm& reference, const Box& box, double top);
std::vector<double> residuals(const Film& film, const ReferenceFilm& reference, const Box& box);

/// Both axes logarithmic.
struct LogPlot {
    Rect plot;
    double x0 = 1, x1 = 10, y0 = 1, y1 = 10;
    Point at(double x, double y) const;
    /// Frame lines, powers of ten on the left, the given values below.
    void axes(
        Frame& f, const std::vector<std::uint64_t>& at_x, const Words& x_name, const Words& y_name, double alpha) const;
};

/// The part of a polyline up to `part` of its length, 0 .. 1.
std::vector<Point> begun(const std::vector<Point>& path, double part);

/// Columns of equal width over the stage.
Rect column_of(double x, double w, double between, std::size_t k);

/// "6.18, Cosine by" .. the arm whose RMSE in a region is the lower, and the other; equal counts as a first.
struct Order {
    RunKey low, high;
    double low_value = 0, high_value = 0;
};
Order order_of(const Data& data, const RunKey& a, const RunKey& b, const std::string& region);

// ---- Axes of a chart: a box on the sheet, each side linear or logarithmic, with ticks whose labels are numbers.

/// A mark on an axis and what stands beside it; no words: a mark alone.
struct Tick {
    double at = 0;
    Words words;
};
/// Powers of ten on the axis, every `step`-th of them.
std::vector<Tick> decades(const Axis& scale, int step = 1);
/// Round values, at most `most` of them.
std::vector<Tick> round_values(const Axis& scale, int most);
/// Those very values.
std::vector<Tick> values(const std::vector<double>& at, int digits);

struct Axes {
    Rect box;
    Axis across, up;

    double x(double v) const { return box.x + box.w * across.share(v); }
    double y(double v) const { return box.bottom() - box.h * up.share(v); }
    Point at(double vx, double vy) const { return {x(vx), y(vy)}; }

    /// The two axes with their ticks, labels left and below, and what each is: over the upright one, under the other.
    void draw(Frame& f, const std::vector<Tick>& below, const std::vector<Tick>& left, const Words& across_name,
        const Words& up_name, double alpha = 1) const;
};

}  // namespace crescent::explainer
