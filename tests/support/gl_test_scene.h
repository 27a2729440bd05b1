// A small scene for the tests of this folder, with everything that a shader supports: every lobe, every kind of body
// before the lights, two lights of which one emits from both sides.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "src/gl/context.h"

namespace crescent::gl::test {

inline constexpr const char* scene_text = R"(
title = "test"
seed = 11
[image]
width = 96
height = 64
[camera]
eye = [0.0, 1.2, 4.4]
target = [0.0, 0.6, 0.0]
up = [0.0, 1.0, 0.0]
vfov_deg = 42.0
[fill]
radiance = [0.5, 0.6, 0.7]
[shapes.phong]
kind = "sphere"
center = [-0.9, 0.7, 0.0]
radius = 0.4
rho_d = [0.3, 0.2, 0.1]
rho_s = 0.2
s = 24.0
alpha = 0.3
occludes = true
[shapes.blinn]
kind = "sphere"
center = [0.0, 0.7, 0.0]
radius = 0.4
rho_d = [0.1, 0.2, 0.3]
brdf = "blinn-phong"
rho_s = 0.2
s = 40.0
alpha = 0.2
occludes = true
[shapes.ggx]
kind = "sphere"
center = [0.9, 0.7, 0.0]
radius = 0.4
rho_d = [0.2, 0.2, 0.2]
brdf = "ggx"
rho_s = 0.2
s = 24.0
alpha = 0.15
occludes = true
[shapes.beckmann]
kind = "sphere"
center = [0.45, 1.3, -0.6]
radius = 0.3
rho_d = [0.2, 0.3, 0.2]
brdf = "beckmann"
rho_s = 0.2
s = 24.0
alpha = 0.25
occludes = true
[shapes.block]
kind = "box"
min = [-1.2, 0.0, -0.6]
max = [1.2, 0.3, 0.6]
rho_d = [0.4, 0.4, 0.4]
s = 24.0
alpha = 0.5
occludes = true
[shapes.card]
kind = "quad"
corner = [-1.0, 1.1, 0.6]
edge_u = [0.5, 0.0, 0.0]
edge_v = [0.0, 0.3, 0.1]
rho_d = [0.2, 0.3, 0.2]
s = 24.0
alpha = 0.5
occludes = true
[shapes.plate]
kind = "disk"
center = [0.7, 1.4, 0.4]
normal = [0.0, 0.8, 0.6]
radius = 0.25
rho_d = [0.3, 0.3, 0.2]
s = 24.0
alpha = 0.5
occludes = true
[shapes.ground]
kind = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 1.0, 0.0]
rho_d = [0.5, 0.5, 0.5]
s = 24.0
alpha = 0.5
occludes = true
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
box = [0, 0, 7, 7]
)";

inline Experiment small_scene(const std::vector<std::string>& overrides = {}) {
    return parse(scene_text, "test.toml", overrides);
}

/// Every built-in sampler with a GLSL version.
inline std::vector<std::string> all_arms() {
    std::vector<std::string> names;
    for (const SamplerInfo& arm : sampler_infos())
        if (arm.gl.relative > 0) names.emplace_back(arm.name);
    return names;
}

/// The context of the tests, opened once: CRESCENT_GL_CONTEXT (egl, osmesa), by default the back end's own choice.
/// EGL's and OSMesa's drivers share tables within a process, so that one process uses only one of them.
inline Context& context() {
    const char* kind = std::getenv("CRESCENT_GL_CONTEXT");
    static const std::unique_ptr<Context> one = open_context({kind ? kind : "", -1});
    if (!one->is_current()) one->make_current();
    return *one;
}

}  // namespace crescent::gl::test
