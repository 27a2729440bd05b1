// The shape that s belongs to: the one that s_of names, else the first with a lobe, else the first that states an s.
#include "scene/scene_data.h"

#include <algorithm>

namespace crescent::inline scene {

const Shape* SceneData::shape_of_s() const {
    const auto first = [&](auto holds) {
        const auto it = std::find_if(shapes.begin(), shapes.end(),
            [&](const Shape& shape) { return shape.material.s && !shape.material.inherits_s && holds(shape); });
        return it == shapes.end() ? nullptr : &*it;
    };
    if (const Shape* named = first([&](const Shape& shape) { return shape.name == s_of; }); named && !s_of.empty())
        return named;
    if (const Shape* lobe = first([](const Shape& shape) { return shape.material.rho_s > 0; })) return lobe;
    return first([](const Shape&) { return true; });
}

double SceneData::s() const {
    const Shape* shape = shape_of_s();
    return shape ? *shape->material.s : 0;
}

const Shape* SceneData::find_shape(std::string_view name) const {
    const auto it = std::find_if(shapes.begin(), shapes.end(), [&](const Shape& shape) { return shape.name == name; });
    return it == shapes.end() ? nullptr : &*it;
}

}  // namespace crescent::inline scene
