// Planted faults: each wraps a right arm in a few lines that break it in one way that samplers are broken in. The bench
// must catch every one of them; `crescent check --planted` prints which verdict does.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "verdicts/work.h"

namespace crescent {

struct PlantedFault {
    std::string name;    // a few words
    std::string breaks;  // the arm it breaks
    std::vector<Trial> trials;
};

std::vector<PlantedFault> planted_faults(bool full);

}  // namespace crescent
