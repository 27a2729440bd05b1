// A half-circle polar plot: an angle from -90 to 90 deg from n, a radius from 0 to the round number above `peak`, in
// 1/sr.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "plates/style.h"

namespace crescent::plates {

struct PolarCurve {
    bool filled = false;
    Colour ink;
    std::string name;
    std::function<double(double)> value;  // of the angle in radians
};
struct PolarPlot {
    Rect slot;
    double legend_w = 0;  // at the right of the slot
    double peak = 1;      // the largest value; the outer circle is the next round one
    double tilt = 0;      // of R, radians
    std::vector<PolarCurve> curves;
};
/// Densities in the plane of n and R, as polar curves.
void draw_polar(Canvas& canvas, const PolarPlot& plot);

}  // namespace crescent::plates
