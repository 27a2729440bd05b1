// Axes of a chart: a box on the sheet, each side linear or logarithmic, with ticks whose labels are numbers.
#pragma once

#include <vector>

#include "frame.h"

namespace crescent::film {

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

}  // namespace crescent::film
