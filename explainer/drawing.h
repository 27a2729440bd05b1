// What several shots draw: outlines of regions on pictures, residuals, a logarithmic plot.
#pragma once

#include <string>
#include <vector>

#include "data.h"
#include "frame.h"
#include "style.h"

namespace crescent::film {

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

}  // namespace crescent::film
