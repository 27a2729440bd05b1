// The files of the scene that an experiment names.
#pragma once

#include "scene/sky.h"

namespace crescent::inline experiment {

/// Reads the image of a sky and sets its content hash. Throws InputError with the file and the texel: no image, a
/// texel that is negative, not finite or too bright, no light, or another image than the experiment expects.
void load_sky(SkyLight& sky);

}  // namespace crescent::inline experiment
