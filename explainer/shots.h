// The shots of the film in their order; one file each under shots/.
#pragma once

#include <vector>

#include "data.h"
#include "shot.h"

namespace crescent::film {

Shot title(const Data& data);
Shot columns(const Data& data);
Shot one_pixel(const Data& data);
Shot same_randoms(const Data& data);
Shot firefly(const Data& data);
Shot ladder_cosine(const Data& data);
Shot ladder_phong(const Data& data);
Shot heat(const Data& data);
Shot failure_b(const Data& data);
Shot heavy_tail(const Data& data);
Shot tilt(const Data& data);
Shot exponent(const Data& data);
Shot seeds(const Data& data);
Shot beyond(const Data& data);
Shot claims(const Data& data);
Shot closing(const Data& data);

/// All of them, with what they show made ready; one that has nothing to show in this run lasts 0 s and is left out.
std::vector<Shot> shots_of(const Data& data);

}  // namespace crescent::film
