// The experiment that is made for a mesh is one that the parser accepts, with a camera that sees all of it.
#include "experiment/model_experiment.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "experiment/experiment.h"

namespace crescent {
namespace model_experiment_test {

std::shared_ptr<const MeshPack> tetrahedron() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return make_pack(std::move(mesh));
}

TEST(ModelExperiment, IsReadByTheParser) {
    for (const bool sky : {false, true}) {
        const Experiment e = parse(
            experiment_for({{"my model.mesh", tetrahedron()}}, sky ? std::optional("s.image") : std::nullopt), "e");
        EXPECT_EQ(e.meshes.at(0).name, "my_model");
        EXPECT_EQ(e.meshes.at(0).file, "my model.mesh");
        EXPECT_EQ(e.sky.has_value(), sky);
        EXPECT_EQ(e.arms.size(), 3u);
        EXPECT_EQ(e.reference.kind, ReferenceKind::paired);
    }
}

TEST(ModelExperiment, SeesAModelFarFromTheOrigin) {
    for (const double distance : {0.0, 4e5}) {
        Bounds box;
        for (const double side : {0.0, 1.5}) {
            const double x = distance + side;
            box.add(Vec3f{static_cast<float>(x), static_cast<float>(-x), static_cast<float>(2 * x)});
        }
        std::string text = experiment_for({{"far.mesh", tetrahedron()}}, std::nullopt);
        const std::size_t begin = text.find("[camera]"), end = text.find("\n\n", begin);
        text.replace(begin, end - begin, camera_table(box));
        const Camera camera = parse(text, "far").camera;
        const Vec3d middle = 0.5 * (widen(box.low) + widen(box.high)), size = widen(box.high) - widen(box.low);
        const double radius = 0.5 * std::sqrt(dot(size, size));
        const Vec3d offset = camera.target - middle, view = camera.eye - camera.target;
        EXPECT_LT(std::sqrt(dot(offset, offset)), 1e-4 * radius) << distance;
        EXPECT_NEAR(std::sqrt(dot(view, view)) / radius, 1.05 / std::sin(20 * pi / 180), 1e-3) << distance;
    }
}

TEST(ModelExperiment, OfAWholeSceneHasItsMaterialsCopiesAndCamera) {
    ModelScene scene;
    scene.title = "a car";
    scene.box = tetrahedron()->mesh.bounds();
    scene.meshes.push_back({.name = "paint", .file = "meshes/paint.mesh", .rho_d = {0.5, 0.25, 0.125}});
    scene.meshes.push_back({.name = "lamp",
        .file = "meshes/lamp.mesh",
        .rho_s = {1, 0.5, 0.25},
        .emission = {3, 2, 1},
        .alpha = 0.25,
        .two_sided = true,
        .rho_d_texture = "textures/lamp.exr",
        .instances = {{1, 0, 0, 2, 0, 1, 0, 3, 0, 0, 1, 4}}});
    scene.aspect = 2;
    scene.camera = Camera{.eye = {0, 1, 5}, .target = {0, 1, 0}, .up = {0, 1, 0}, .vfov_deg = 30};
    const Experiment e = parse(experiment_for(scene), "e");
    EXPECT_EQ(e.image.width, 2 * e.image.height);
    EXPECT_EQ(e.camera.eye.z, 5);
    ASSERT_EQ(e.meshes.size(), 2u);
    EXPECT_EQ(e.meshes[0].material.rho_d, (Rgb{0.5, 0.25, 0.125}));
    EXPECT_EQ(e.meshes[1].instances.at(0).transform().point({0, 0, 0}).y, 3);
    EXPECT_EQ(e.meshes[1].rho_d_texture.file, "textures/lamp.exr");
    EXPECT_EQ(e.meshes[1].emission, (Rgb{3, 2, 1}));
    const auto& parts = e.find_arm("renderer")->combination.of;
    EXPECT_NE(std::ranges::find(parts, "light-triangle"), parts.end());
}

TEST(ModelExperiment, NamesTablesAfterFiles) {
    EXPECT_EQ(table_name_of("folder/a model.mesh"), "a_model");
    EXPECT_EQ(table_name_of("-x.mesh"), "mesh-x");
    EXPECT_EQ(table_name_of(std::string(100, 'a') + ".mesh").size(), 64u);
}

}  // namespace model_experiment_test
}  // namespace crescent
