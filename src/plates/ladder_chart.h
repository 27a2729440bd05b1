// RMSE of one region against N, both logarithmic, one line per arm with its fitted slope.
#pragma once

#include <string>

#include "plates/sheet.h"

namespace crescent::plates {

/// RMSE of a region against N, both axes logarithmic, one curve an arm with its band.
void draw_ladder_chart(Sheet& sheet, const Rect& slot, const std::string& region);

}  // namespace crescent::plates
