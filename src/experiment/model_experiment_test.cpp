// The experiment that is made for a mesh is one that the parser accepts, with a camera that sees all of it.
#include "experiment/model_experiment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

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

/// The ends of points in a square image from -1 to 1.
struct Frame {
    double x_low = INFINITY, x_high = -INFINITY, y_low = INFINITY, y_high = -INFINITY;
    bool is_in_front = true;
    double largest() const { return std::max({-x_low, x_high, -y_low, y_high}); }
};
Frame frame_of(const Camera& camera, const std::vector<Vec3f>& points) {
    const auto unit = [](Vec3d v) { return (1 / std::sqrt(dot(v, v))) * v; };
    const Vec3d forward = unit(camera.target - camera.eye), across = unit(cross(forward, camera.up)),
                up = cross(across, forward);
    const double tangent = std::tan(camera.vfov_deg * pi / 360);
    Frame out;
    for (const Vec3f& p : points) {
        const Vec3d to = widen(p) - camera.eye;
        const double depth = dot(to, forward);
        const double x = dot(to, across) / (tangent * depth), y = dot(to, up) / (tangent * depth);
        out.is_in_front = out.is_in_front && depth > 0;
        out.x_low = std::min(out.x_low, x);
        out.x_high = std::max(out.x_high, x);
        out.y_low = std::min(out.y_low, y);
        out.y_high = std::max(out.y_high, y);
    }
    return out;
}

std::vector<Vec3f> corners_of(const Bounds& box) {
    std::vector<Vec3f> out;
    for (unsigned corner = 0; corner < 8; ++corner)
        out.push_back({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
            corner & 4 ? box.high.z : box.low.z});
    return out;
}

/// The camera that is made for these points.
Camera camera_for(const ModelPoints& points, double aspect) {
    std::string text = experiment_for({{"m.mesh", tetrahedron()}}, std::nullopt);
    const std::size_t begin = text.find("[camera]"), end = text.find("\n\n", begin);
    text.replace(begin, end - begin, camera_table(points, aspect));
    return parse(text, "view").camera;
}

TEST(ModelExperiment, SeesAModelFarFromTheOrigin) {
    for (const double distance : {0.0, 4e5}) {
        Bounds box;
        for (const double side : {0.0, 1.5}) {
            const double x = distance + side;
            box.add(Vec3f{static_cast<float>(x), static_cast<float>(-x), static_cast<float>(2 * x)});
        }
        const Camera camera = camera_for(ModelPoints(box), 1);
        const Vec3d middle = 0.5 * (widen(box.low) + widen(box.high)), size = widen(box.high) - widen(box.low);
        const double radius = 0.5 * std::sqrt(dot(size, size));
        const Vec3d offset = camera.target - middle, view = camera.eye - camera.target;
        EXPECT_LT(std::sqrt(dot(offset, offset)), 0.3 * radius) << distance;
        EXPECT_NEAR(std::sqrt(dot(view, view)) / radius, 1 / std::sin(20 * pi / 180), 1e-3) << distance;
        const Frame frame = frame_of(camera, corners_of(box));
        EXPECT_NEAR(frame.largest(), 1 / 1.05, 1e-3) << distance;
    }
}

/// A box of this size about the origin, turned by two angles.
Mesh box_of(Vec3d size, double yaw, double pitch) {
    Mesh out;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3d p{
            (corner & 1 ? 0.5 : -0.5) * size.x, (corner & 2 ? 0.5 : -0.5) * size.y, (corner & 4 ? 0.5 : -0.5) * size.z};
        const Vec3d q{
            p.x, std::cos(pitch) * p.y - std::sin(pitch) * p.z, std::sin(pitch) * p.y + std::cos(pitch) * p.z};
        out.positions.push_back({static_cast<float>(std::cos(yaw) * q.x + std::sin(yaw) * q.z), static_cast<float>(q.y),
            static_cast<float>(-std::sin(yaw) * q.x + std::cos(yaw) * q.z)});
    }
    for (const auto& [a, b, c, d] : {std::array<std::uint32_t, 4>{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6},
             {0, 2, 6, 4}, {1, 5, 7, 3}}) {
        out.triangles.push_back({a, c, b});
        out.triangles.push_back({a, d, c});
    }
    return out;
}

/// Pixels of a square image of 64 that see a mesh, and whether all of its corners are in it.
struct View {
    int pixels = 0;
    bool has_corners = true;
};
View view_of(const Mesh& mesh) {
    const Camera c = camera_for(ModelPoints(mesh), 1);
    const auto unit = [](Vec3d v) { return (1 / std::sqrt(dot(v, v))) * v; };
    const Vec3d forward = unit(c.target - c.eye), across = unit(cross(forward, c.up)), up = cross(across, forward);
    const double tangent = std::tan(c.vfov_deg * pi / 360);
    const Frame frame = frame_of(c, mesh.positions);
    View out;
    out.has_corners = frame.is_in_front && frame.largest() < 1;
    constexpr int side = 64;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const Vec3d d =
                forward + (tangent * (2 * (i + 0.5) / side - 1)) * across + (tangent * (2 * (j + 0.5) / side - 1)) * up;
            for (const Triangle& t : mesh.triangles) {  // Moeller and Trumbore 1997
                const Vec3d a = widen(mesh.positions[t[0]]), u = widen(mesh.positions[t[1]]) - a,
                            v = widen(mesh.positions[t[2]]) - a, s = c.eye - a, p = cross(d, v), q = cross(s, u);
                const double determinant = dot(u, p), x = dot(s, p) / determinant, y = dot(d, q) / determinant;
                if (!(x >= 0 && y >= 0 && x + y <= 1)) continue;
                ++out.pixels;
                break;
            }
        }
    return out;
}

TEST(ModelExperiment, SeesAllOfAModelOfAnyAspect) {
    for (const Vec3d size : {Vec3d{1, 1, 1}, Vec3d{1000, 1, 1}, Vec3d{1, 1000, 1}, Vec3d{1, 1, 1000}, Vec3d{10, 1, 1},
             Vec3d{1000, 30, 1}, Vec3d{1, 1000, 1000}, Vec3d{1000, 1, 1000}, Vec3d{1000, 1000, 1}, Vec3d{1000, 1000, 0},
             Vec3d{1e5, 1, 1}, Vec3d{1000, 1, 0}})
        for (const double yaw : {0.0, 0.4, 0.785, 2.0})
            for (const double pitch : {0.0, 0.35, 1.0, 1.5}) {
                const View view = view_of(box_of(size, yaw, pitch));
                EXPECT_TRUE(view.has_corners)
                    << size.x << " x " << size.y << " x " << size.z << ", turned by " << yaw << ", " << pitch;
                EXPECT_GT(view.pixels, 40)
                    << size.x << " x " << size.y << " x " << size.z << ", turned by " << yaw << ", " << pitch;
            }
}

/// One pair of opposite sides of the image is as far from the model as the margin, the other pair is equally far.
TEST(ModelExperiment, FillsTheImageWithAModelOfAnyAspect) {
    for (const Vec3d size : {Vec3d{1, 1, 1}, Vec3d{7, 1, 1}, Vec3d{1, 7, 1}, Vec3d{1, 1, 7}, Vec3d{1000, 1, 1},
             Vec3d{1, 1000, 1}, Vec3d{1, 1000, 1000}, Vec3d{1000, 1, 1000}, Vec3d{1000, 1000, 0}})
        for (const double yaw : {0.0, 0.4, 2.0})
            for (const double pitch : {0.0, 0.35, 1.5})
                for (const double aspect : {0.5, 4.0 / 3, 2.0}) {
                    const Mesh mesh = box_of(size, yaw, pitch);
                    Frame frame = frame_of(camera_for(ModelPoints(mesh), aspect), mesh.positions);
                    frame.x_low /= aspect;
                    frame.x_high /= aspect;
                    const testing::Message what = testing::Message()
                        << size.x << " x " << size.y << " x " << size.z << ", turned by " << yaw << ", " << pitch;
                    EXPECT_NEAR(frame.largest(), 1 / 1.05, 2e-3) << what;
                    EXPECT_NEAR(frame.x_low + frame.x_high, 0, 4e-3) << what;
                    EXPECT_NEAR(frame.y_low + frame.y_high, 0, 4e-3) << what;
                    EXPECT_NEAR(std::max(frame.x_high - frame.x_low, frame.y_high - frame.y_low), 2 / 1.05, 4e-3)
                        << what;
                }
}

TEST(ModelExperiment, OfAWholeSceneHasItsMaterialsCopiesAndCamera) {
    ModelScene scene;
    scene.title = "a car";
    scene.points.add(tetrahedron()->mesh);
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

TEST(ModelExperiment, HasARegionOfTheImageAtAnySize) {
    ModelScene scene;
    scene.title = "m";
    scene.points.add(tetrahedron()->mesh);
    scene.meshes.push_back({.name = "m", .file = "m.mesh"});
    const Experiment e = parse(experiment_for(scene), "e", {"image={width=64,height=48}"});
    EXPECT_EQ(e.find_region("all")->box, (Box{0, 0, 63, 47}));
}

/// A room is seen from within although no corner of it is in the image; what is behind, or beyond a side, is not.
TEST(ModelPoints, MayBeSeenUnlessBeyondASide) {
    const ModelPoints room(Bounds{{-5, -5, -5}, {5, 5, 5}}), far(Bounds{{199, -1, -1}, {201, 1, 1}});
    const Camera camera{.eye = {0, 0, 3}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vfov_deg = 40};
    EXPECT_TRUE(room.may_be_seen(camera, 1.5));
    EXPECT_FALSE(far.may_be_seen(camera, 1.5));
    EXPECT_TRUE(far.may_be_seen({.eye = {150, 0, 0}, .target = {200, 0, 0}, .up = {0, 1, 0}, .vfov_deg = 40}, 1.5));
    EXPECT_FALSE(far.may_be_seen({.eye = {250, 0, 0}, .target = {300, 0, 0}, .up = {0, 1, 0}, .vfov_deg = 40}, 1.5));
    const Camera wide{.eye = {100, 0, 100}, .target = {100, 0, 0}, .up = {0, 1, 0}, .vfov_deg = 60};
    EXPECT_FALSE(far.may_be_seen(wide, 1));  // 45 degrees to the right
    EXPECT_TRUE(far.may_be_seen(wide, 2));
}

TEST(ModelExperiment, NamesTablesAfterFiles) {
    EXPECT_EQ(table_name_of("folder/a model.mesh"), "a_model");
    EXPECT_EQ(table_name_of("-x.mesh"), "mesh-x");
    EXPECT_EQ(table_name_of(std::string(100, 'a') + ".mesh").size(), 64u);
}

}  // namespace model_experiment_test
}  // namespace crescent
