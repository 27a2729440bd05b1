// What the camera sees. Lengths in m.
#pragma once

#include <optional>
#include <string>

#include "base/errors.h"
#include "base/vec.h"
#include "scene/material.h"

namespace crescent {

enum class ShapeKind { sphere, box, quad, disk, plane, panel };

/// One shape; which fields count depends on the kind (see `crescent schema`).
struct Shape {
    std::string name;
    ShapeKind kind = ShapeKind::sphere;
    Material material;
    std::optional<Rgb> reveal_rho_d;     // panel: the four sides of the recess
    bool occludes = false;               // whether it blocks the disk lights
    Vec3d center{};                      // sphere, disk
    double radius = 0;                   // sphere, disk
    Vec3d min{}, max{};                  // box
    Vec3d corner{}, edge_u{}, edge_v{};  // quad, panel opening; the outward normal is edge_u x edge_v
    Vec3d point{};                       // plane
    Vec3d normal{};                      // plane, disk; unit
    double depth = 0;                    // panel: how far it is set back, against the normal
    Place at;
};

}  // namespace crescent
