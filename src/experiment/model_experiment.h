// Text of an experiment for models and skies that have none yet: what `crescent import` prints, and a whole experiment.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/mesh/mesh.h"

namespace crescent::inline experiment {

/// Returns the table [camera] of a view in which the whole box is seen, from above and the side.
std::string camera_table(const Bounds& box);

/// Returns the name of a file without folder and extension as the name of a table.
std::string table_name_of(const std::string& file);

/// A mesh and the name of its file.
using NamedMesh = std::pair<std::string, std::shared_ptr<const MeshPack>>;

/// Returns an experiment in which all of these meshes (at least one) are seen, under the sky of a file or, without one,
/// under a disk light: a small image, three arms at three sample counts, a region of the whole image, a short
/// reference.
std::string experiment_for(const std::vector<NamedMesh>& meshes, const std::optional<std::string>& sky);

}  // namespace crescent::inline experiment
