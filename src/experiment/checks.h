// Checks keys against each other: names that must exist, regions on the image, the camera, degenerate shapes.
#pragma once

#include "experiment/parser.h"

namespace crescent {

/// Checks keys against each other: names that must exist, regions on the image, the camera, degenerate shapes.
void check_geometry(ParseContext& context);
void check_names(ParseContext& context);

}  // namespace crescent
