// Pictures of a comparison, by file name without .png.
#pragma once

#include <map>

#include "compare/results.h"
#include "plates/plates.h"

namespace crescent::inline comparing {

/// renders, errors, ladders, bias-A-B, noise-A-B: those that there is something to show for. Throws OutputError without
/// the font.
std::map<std::string, Picture> compare_plates(
    const ComparePlan& plan, const Readings& all, const CompareResult& result);

struct Sides;
/// Signed difference of two means, tiles and pixels in which it is told, and the ratio of two variances.
Picture difference_plate(const Sides& sides, const std::string& a, const std::string& b, Theme theme);
Picture bias_plate(const Sides& sides, const BiasResult& found, Theme theme);
Picture noise_plate(const Readings& all, const NoiseResult& noise, Theme theme);
/// Needs a ladder.
Picture ladders_plate(const CompareResult& result, Theme theme);
std::string ladders_svg(const CompareResult& result, Theme theme);

}  // namespace crescent::inline comparing
