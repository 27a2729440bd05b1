// Where a model is put, so that an experiment can hold it.
#pragma once

#include "model.h"

namespace crescent::importer {

/// x' = scale (x - from).
struct ModelPlacement {
    Vec3d from{};
    double scale = 1;

    Vec3d placed(Vec3d p) const { return scale * (p - from); }
    bool is_needed() const { return scale != 1 || from.x != 0 || from.y != 0 || from.z != 0; }
};

/// Moves a model to the origin, and scales it by a power of two to a size of 1 to 2, if an experiment could not place
/// it as it is: its coordinates are above 1e5, its size is below 1e-3, or its coordinates are above 1e4 times its size.
/// The same for every material of a model, so that its parts fit.
ModelPlacement placement_of(const Model& model);

}  // namespace crescent::importer
