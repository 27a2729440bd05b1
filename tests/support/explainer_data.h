// A small run of everything the explainer needs, made once for all tests: a glossy ball before an area light, 96 x 54
// pixels.
#pragma once

#include "data.h"

namespace crescent::explainer::test {

inline Experiment small_experiment() {
    return parse(R"(
title = "A small film"
seed = 7
seeds = 2
n = 16
[image]
width = 96
height = 54
[camera]
eye = [0, 0.8, 3.2]
target = [0, 0.5, 0]
vfov_deg = 42
[shapes.ball]
kind = "sphere"
center = [0, 0.65, 0]
radius = 0.65
rho_d = [0.155, 0.175, 0.188]
rho_s = 0.12
s = 32
occludes = true
[shapes.floor]
kind = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
rho_d = [0.1, 0.08, 0.06]
[disks.key]
center = [1.2, 2.9, 1.3]
normal = [-0.48, -0.81, -0.3369]
radius = 0.3
radiance = [90, 80, 70]
[fill]
radiance = [1.2, 1.38, 1.62]
[arms.uniform]
n = [4, 16]
[arms.cosine]
n = [4, 16]
[arms.phong]
n = [4, 16]
[exponent]
arm = "phong"
s = [8, 32]
shape = "ball"
[regions.H]
box = [48, 36, 64, 48]
[regions.S]
box = [20, 2, 76, 12]
)",
        "small.toml");
}

inline const Data& small_data() {
    static const Data data = [] {
        ProgressMonitor monitor;
        return collect(small_experiment(), {}, monitor);
    }();
    return data;
}

}  // namespace crescent::explainer::test
