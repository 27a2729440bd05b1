// The lights of an experiment, whichever of its two tables names them, and how --set reaches them.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_data.h"

namespace crescent::inline experiment {

/// A light of [disks.NAME] or of [lights.NAME], and the path of that table for --set: "disks.key".
struct LightTable {
    std::string path;
    Light light;
};
/// All lights of a scene but the fill, in the order in which it has them: disks first.
std::vector<LightTable> all_lights(const SceneData& scene);

/// What --set takes to make a light `factor` times as wide about its centre ("disks.key.radius=0.4"); empty for a kind
/// that has neither lengths nor edges.
std::vector<std::string> widened(const LightTable& table, double factor);

}  // namespace crescent::inline experiment
