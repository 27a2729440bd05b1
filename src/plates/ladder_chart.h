// RMSE of one region against N, both logarithmic, one line per arm with its fitted slope.
#pragma once

#include <string>

#include "plates/sheet.h"

namespace crescent::plates {

void draw_ladder_chart(Sheet& sheet, const Rect& slot, const std::string& region);

}  // namespace crescent::plates
