// Text of an experiment for models and skies that have none yet: what `crescent import` prints, and a whole experiment.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiment/model_camera.h"
#include "scene/mesh/mesh.h"
#include "scene/scene_data.h"

namespace crescent {

/// Returns the name of a file without folder and extension as the name of a table.
std::string table_name_of(const std::string& file);

/// A mesh and the name of its file.
using NamedMesh = std::pair<std::string, std::shared_ptr<const MeshPack>>;

/// Returns an experiment in which all of these meshes (at least one) are seen, under the sky of a file or, without one,
/// under a disk light: a small image, three arms at three sample counts, a region of the whole image, a short
/// reference.
std::string experiment_for(const std::vector<NamedMesh>& meshes, const std::optional<std::string>& sky);

/// A mesh of a model's scene, with the keys of its table.
struct ModelMesh {
    std::string name, file;
    Rgb rho_d{0.5, 0.5, 0.5}, rho_s{}, emission{};
    double alpha = 0.5;
    bool two_sided = false;
    std::string rho_d_texture = {}, alpha_texture = {};  // "": none
    std::vector<std::array<double, 12>> instances = {};  // matrices by rows; empty: it is there once
};

/// What a model has that becomes an experiment.
struct ModelScene {
    std::string title;
    ModelPoints points;  // of all meshes where they are
    std::vector<ModelMesh> meshes;
    std::optional<Camera> camera;    // none: one that sees the box
    double aspect = 4.0 / 3;         // width over height
    std::optional<std::string> sky;  // a file; none: a disk light
    std::string sky_layer = {};      // of it; "": its first part
};

/// Returns an experiment of a whole scene: the arms that its lights and materials call for at three sample counts,
/// plates of two of them, a region of the whole image, a reference.
std::string experiment_for(const ModelScene& scene);

}  // namespace crescent
