// What the camera sees. Lengths in m.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"
#include "scene/material.h"
#include "scene/shapes/all.h"

namespace crescent::inline scene {

/// One shape: where it lies, what it reflects.
struct Shape {
    std::string name;
    Shapes::Any form;  // one of the kinds of shapes/all.h
    Material material;
    bool occludes = false;  // whether it stands before the lights
    SourceLocation at;
    std::string_view kind() const { return Shapes::names[form.index()]; }
};

/// A convex body that can stand between a surface and a light. A shape that is not convex is made of several.
struct Occluder {
    Bodies::Any body;
    int shape = -1;  // its own surface is never shadowed by it
};

/// Where the ray x + t d first meets the shape.
Intersection intersect(const Shape& shape, Vec3d x, Vec3d d);

/// What it puts before lights, as shape `index`.
void add_occluders(const Shape& shape, int index, std::vector<Occluder>& out);

/// The diffuse albedo of the sides of a recess, where the shape has one and states it.
std::optional<Rgb> albedo_of_reveal(const Shape& shape);

}  // namespace crescent::inline scene
