// What the shots need beyond what a run measures.
#pragma once

#include <string>

#include "data.h"

namespace crescent::film {

struct Measures {};

/// `data` is complete but for its measures.
Measures take_measures(const Data& data, const std::string& isa, Watch& watch);

}  // namespace crescent::film
