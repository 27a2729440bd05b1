// Changes of a model that its reader asked for.
#pragma once

#include <string>

#include "model.h"

namespace crescent::importer {

/// Keeps the parts whose mesh, node, a node above it, or material has this name. Throws ModelError with the names that
/// there are if none has.
void select(Model& model, const std::string& name);

/// Turns a model whose z axis is up, and scales it about the origin.
void turn_and_scale(Model& model, bool z_is_up, double scale);

/// Gives a part without normals those of its surface: at a corner of a triangle, the mean of the normals of the
/// triangles that have a corner at this place and whose normal is within so many degrees, by their angles there
/// (Thuermer, Wuethrich 1998).
void smooth(Model& model, double degrees);

}  // namespace crescent::importer
