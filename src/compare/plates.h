// Pictures of a comparison, by file name without .png.
#pragma once

#include <map>

#include "compare/results.h"
#include "plates/plates.h"

namespace crescent {

/// renders, errors, bias-A-B, noise-A-B: those that there is something to show for. Throws OutputError without the
/// font.
std::map<std::string, Picture> compare_plates(
    const ComparePlan& plan, const Readings& all, const CompareResult& result);

}  // namespace crescent
