// A scene as plain data: made in code, or read from an experiment file. Lengths in m, radiance in W/(sr m^2), angles in
// degrees, albedos in [0, 1]; y is up; the camera space is right-handed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/camera.h"
#include "scene/light.h"
#include "scene/shape.h"

namespace crescent::inline scene {

struct SceneData {
    Image image;
    Camera camera;
    std::vector<Shape> shapes;
    std::vector<DiskLight> disks;  // lights too, before the others
    std::vector<Light> lights;
    Rgb fill{};  // uniform over the hemisphere
    std::string
        s_of;  // the shape whose exponent is the scene's; empty: the first with a lobe, else the first with an s

    /// The scene's own s, which steers arms on surfaces without a lobe: that of shape_of_s(); 0 where none has one.
    double s() const;
    /// The shape whose exponent that is; null where no shape has one of its own.
    const Shape* shape_of_s() const;
    const Shape* find_shape(std::string_view name) const;
};

}  // namespace crescent::inline scene
