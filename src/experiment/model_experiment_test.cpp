// The experiment that is made for a mesh is one that the parser accepts, with a camera that sees all of it.
#include "experiment/model_experiment.h"

#include <gtest/gtest.h>

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

TEST(ModelExperiment, NamesTablesAfterFiles) {
    EXPECT_EQ(table_name_of("folder/a model.mesh"), "a_model");
    EXPECT_EQ(table_name_of("-x.mesh"), "mesh-x");
    EXPECT_EQ(table_name_of(std::string(100, 'a') + ".mesh").size(), 64u);
}

}  // namespace model_experiment_test
}  // namespace crescent
