// The column of facts beside a single picture: a title, its density, then names and values in two columns.
#pragma once

#include <utility>

#include "plates/sheet.h"

namespace crescent::plates {

inline constexpr double facts_width = 232;
/// Left of the facts: where a single picture stands, 960x540 as the published one.
inline constexpr Rect picture_slot{content_band.x, content_band.y, sheet_inner - facts_width - 24, content_band.h};
inline constexpr Rect facts_slot{
    content_band.x + sheet_inner - facts_width, content_band.y, facts_width, content_band.h};

struct Fact {
    std::string name, value;
};
/// Returns the y under the last line.
double facts(Sheet& sheet, const std::string& title, const std::string& under_title, const std::vector<Fact>& list);

}  // namespace crescent::plates
