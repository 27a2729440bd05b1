// A small scene for tests: a glossy ball on a box before a wall, two area lights, with penumbrae visible.
#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "experiment/experiment.h"
#include "samplers/all.h"

namespace crescent::test {

/// Every built-in sampler that finds some light in a scene without a sky and without meshes.
inline std::vector<std::string> all_arms() {
    std::vector<std::string> names;
    for (const SamplerInfo& info : sampler_infos())
        if (info.reaches.fill || info.reaches.lights) names.emplace_back(info.name);
    return names;
}

/// Sum of (x - mean x)^2, in two passes.
inline double spread_of(std::span<const float> x) {
    double sum = 0, square = 0;
    for (const float v : x) sum += static_cast<double>(v);
    const double mean = sum / static_cast<double>(x.size());
    for (const float v : x) square += sqr(static_cast<double>(v) - mean);
    return square;
}

inline Experiment small_scene(const std::vector<std::string>& overrides = {}) {
    return parse(R"(
title = "test"
seed = 11
[image]
width = 67
height = 45
[camera]
eye = [0.0, 1.0, 4.0]
target = [0.0, 0.6, 0.0]
up = [0.0, 1.0, 0.0]
vfov_deg = 40.0
[fill]
radiance = [0.5, 0.6, 0.7]
[shapes.ball]
kind = "sphere"
center = [0.0, 0.9, 0.0]
radius = 0.6
rho_d = [0.3, 0.2, 0.1]
rho_s = 0.2
s = 24.0
occludes = true
[shapes.block]
kind = "box"
min = [-0.7, 0.0, -0.7]
max = [0.7, 0.3, 0.7]
rho_d = [0.4, 0.4, 0.4]
occludes = true
[shapes.ground]
kind = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 1.0, 0.0]
rho_d = [0.5, 0.5, 0.5]
[disks.left]
center = [-1.5, 2.5, 1.0]
normal = [0.0, -1.0, 0.0]
radius = 0.4
radiance = [20.0, 18.0, 15.0]
[disks.right]
center = [2.0, 2.0, 2.0]
normal = [-0.6, -0.8, 0.0]
radius = 0.2
radiance = [30.0, 40.0, 50.0]
two_sided = true
[arms.uniform]
n = [64]
[arms.cosine]
n = [4, 64]
[arms.phong]
n = [4, 64]
[regions.all]
box = [0, 0, 66, 44]
)",
        "test.toml", overrides);
}

/// Moves camera, bodies and lights.
inline void shift(Experiment& e, Vec3d by) {
    for (Vec3d* at : {&e.camera.eye, &e.camera.target}) *at = *at + by;
    const auto moved = [&]<class Form>(Form& form) {
        if constexpr (requires { form.center; }) form.center = form.center + by;
        if constexpr (requires { form.min; }) {
            form.min = form.min + by;
            form.max = form.max + by;
        }
        if constexpr (requires { form.corner; }) form.corner = form.corner + by;
        if constexpr (requires { form.point; }) form.point = form.point + by;
    };
    for (Shape& shape : e.shapes) std::visit(moved, shape.form);
    for (Light& light : e.lights) std::visit(moved, light.form);
    for (DiskLight& disk : e.disks) disk.center = disk.center + by;
}

}  // namespace crescent::test
