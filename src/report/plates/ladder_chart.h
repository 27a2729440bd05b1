// A quantity of one region against N, both logarithmic, one curve per arm with its fitted slope.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/plates/sheet.h"

namespace crescent::plates {

struct LadderCurve {
    std::string name;
    Colour ink;
    std::vector<double> n, value;
    std::vector<std::pair<double, double>> interval;  // for each value; empty: none is drawn; NaN: none for this one
    double slope = 0, low = 0, high = 0;              // of log value over log N, and its interval; NaN: none
    bool heavy = false;                               // the tail is too heavy for a meaningful slope
};

/// `title` is markup. Nothing is drawn without curves.
void draw_ladder_chart(
    Canvas& canvas, const Rect& slot, const std::string& title, const std::vector<LadderCurve>& curves);

/// Returns the RMSE of a region of a run against N, one curve for each arm that the plate shows.
std::vector<LadderCurve> ladder_curves(const Sheet& sheet, const std::string& region);

}  // namespace crescent::plates
