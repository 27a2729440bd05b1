// The keys of a compare file and the quantities of its checks: one table each.
#pragma once

#include <vector>

#include "compare/plan.h"
#include "experiment/quantity_text.h"
#include "experiment/schema.h"

namespace crescent::inline comparing {

/// The table of a comparison file, as schema() is that of an experiment.
const Section& compare_schema();
const std::vector<QuantityWord>& compare_words();

/// The region that is every pixel; a footnote, never a headline.
inline constexpr const char* whole_frame = "frame";

}  // namespace crescent::inline comparing
