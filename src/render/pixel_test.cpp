// Compares the samples of one pixel with the kernels: the same X, bit for bit, for every sampler, and the film's own Y.
#include "render/pixel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "render/estimator.h"
#include "tests/support/meshes.h"
#include "tests/support/skies.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace pixel_test {

constexpr std::uint64_t n = 48;

/// Returns pixels of the test scene: the ball's highlight, its side, the block, the ground and its shadow.
std::vector<std::pair<int, int>> pixels(const Scene& scene) {
    std::vector<std::pair<int, int>> out;
    for (int j = 2; j < scene.image().height; j += 5)
        for (int i = 1; i < scene.image().width; i += 6)
            if (scene.primary(i, j)) out.emplace_back(i, j);
    return out;
}

template <class Visit> void for_each_opened(Visit&& visit, const Experiment& e = test::small_scene()) {
    const Scene scene(e);
    for (const auto& [i, j] : pixels(scene)) visit(scene, OpenPixel(scene, i, j));
}

/// A sky, a glossy ball of triangles with smooth normals and a shining one.
Experiment with_surroundings() {
    Experiment e = test::small_scene();
    e.sky = test::noisy_sky(16, 4);
    for (const double x : {-0.6, 0.7}) {
        MeshObject& ball = e.meshes.emplace_back();
        ball.name = x < 0 ? "glossy" : "shining";
        ball.pack = make_pack(test::sphere_mesh(14, 9));
        ball.placement.translate = {x, 0.6, 0.9};
        ball.placement.scale = {0.3, 0.3, 0.3};
        ball.material.rho_d = {0.3, 0.2, 0.1};
        ball.material.rho_s = 0.4;
        ball.material.s = 20;
        if (x > 0) ball.emission = {3, 2, 1};
    }
    return e;
}

/// Returns the lights that were met; -1 for the fill, -2 for light that varies.
std::set<int> expect_kernels_draws(const Experiment& e) {
    std::set<int> lights;
    const auto compare = [&](const Scene& scene, const OpenPixel& pixel) {
        const std::vector<ShadingPoints> shading_points =
            shading_points_of(scene, {pixel.i(), pixel.j(), pixel.i() + 1, pixel.j() + 1}, nullptr);
        for_each_sampler(Samplers{}, [&]<template <class> class A>() {
            std::vector<float> x(n);
            estimate_points(shading_points[0], A<float>::name, n, 11, "", nullptr, x.data());
            std::vector<float> opened(n);
            for (std::size_t at = 0; const PixelSample& sample : pixel.samples(A<float>::name, n, 11)) {
                lights.insert(sample.meets_surroundings ? -2 : sample.disk);
                if (sample.technique == 0) opened[at++] = sample.x;
                else opened[at - 1] += sample.x;
            }
            EXPECT_EQ(opened, x) << A<float>::name << " at " << pixel.i() << ", " << pixel.j();
        });
    };
    for_each_opened(compare, e);
    return lights;
}

TEST(OpenPixel, DrawsWhatTheKernelsDrawBitForBit) {
    EXPECT_EQ(expect_kernels_draws(test::small_scene()), (std::set<int>{-1, 0, 1}));
    EXPECT_EQ(expect_kernels_draws(with_surroundings()), (std::set<int>{-2, -1, 0, 1}));
}

TEST(OpenPixel, IsTheProductOfItsParts) {
    const auto check = [](const Scene&, const OpenPixel& pixel) {
        for (const char* arm : {"cosine", "phong", "mis-balance"})
            for (const PixelSample& s : pixel.samples(arm, n, 11)) {
                if (!(s.x > 0)) continue;
                const double product = double(s.weight) * double(s.f) * double(s.light) * double(s.cos) / double(s.pdf);
                EXPECT_NEAR(product / double(s.x), 1, 1e-6) << arm;
            }
    };
    for_each_opened(check);
    for_each_opened(check, with_surroundings());
}

TEST(OpenPixel, AveragesToTheFilm) {
    const Scene scene(test::small_scene());
    ProgressMonitor monitor;
    for (const char* arm : {"uniform", "cosine", "phong", "mis-power"}) {
        const Film film = estimate_films(scene, arm, {n}, 11, "", monitor).front();
        for (const auto& [i, j] : pixels(scene)) {
            const double y = double(film.y[std::size_t(j) * std::size_t(film.width) + std::size_t(i)]);
            const double mean = running_mean(OpenPixel(scene, i, j).samples(arm, n, 11)).back();
            EXPECT_NEAR(mean, y, 2e-6 * y + 1e-12) << arm << " at " << i << ", " << j;
        }
    }
}

TEST(OpenPixel, AsksTheFieldsWhatItDraws) {
    const auto check = [](const Scene&, const OpenPixel& pixel) {
        for (const PixelSample& s : pixel.samples("cosine", n, 11)) {
            const Vec3d wi = {double(s.wi.x), double(s.wi.y), double(s.wi.z)};
            EXPECT_EQ(pixel.disk_met(wi), s.disk);
            EXPECT_EQ(pixel.meets_light(wi), s.meets_light());
            if (s.light > 0) EXPECT_NEAR(pixel.light(wi) / double(s.light), 1, 1e-6);
            if (s.f > 0 && !s.meets_surroundings) EXPECT_NEAR(pixel.f(wi, s.disk) / double(s.f), 1, 1e-5);
            EXPECT_NEAR(pixel.pdf("cosine", wi) / double(s.pdf), 1, 1e-6);
        }
        EXPECT_EQ(pixel.f({0, 0, -1}), 0);
    };
    for_each_opened(check);
    for_each_opened(check, with_surroundings());
}

TEST(OpenPixel, SeesADiskAsWideAsItsDistanceMakesIt) {
    const Scene scene(test::small_scene());
    const OpenPixel pixel(scene, 33, 30);
    ASSERT_EQ(pixel.lights().size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
        const lights::Disk& light = std::get<lights::Disk>(scene.lights()[k].form);
        const Vec3d to = light.center - pixel.hit().x;
        EXPECT_NEAR(std::tan(pixel.lights()[k].angular_radius * pi / 180), light.radius / length(to), 1e-6);
        EXPECT_NEAR(dot(pixel.lights()[k].towards, frame_about(pixel.hit().n).to_local(normalize(to))), 1, 1e-6);
    }
}

}  // namespace pixel_test
}  // namespace crescent
