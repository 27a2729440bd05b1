// The shots of the film in their order; one file each under shots/.
#pragma once

#include <vector>

#include "data.h"
#include "shot.h"

namespace crescent::film {

Shot title(const Data& data);

/// All of them, with what they show made ready.
std::vector<Shot> shots_of(const Data& data);

}  // namespace crescent::film
