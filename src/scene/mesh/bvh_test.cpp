// The tree against tests of every triangle: the same bits for random, grazing and edge rays, with instances, and for
// tiny, far and flat meshes. Closed meshes let no ray through; a surface does not shadow itself.
#include "scene/mesh/bvh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "base/parallel.h"
#include "math/simd/frame.h"
#include "scene/mesh/bvh_build.h"
#include "scene/mesh/bvh_tree.h"
#include "scene/mesh/rays.h"
#include "tests/support/meshes.h"

namespace crescent {
namespace bvh_test {

using test::sphere_mesh;
using test::unit_vector;

struct Ray {
    Vec3f o, d;
};

/// Rays of each kind: from outside and inside, along edges, from corner to corner, along the axes.
std::vector<Ray> rays_about(const Mesh& mesh, std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> number(-1, 1);
    const Bounds box = mesh.bounds();
    const Vec3f middle = 0.5f * (box.low + box.high), half = 0.5f * (box.high - box.low);
    const auto place = [&](float far) {
        const Vec3f v = {number(random), number(random), number(random)};
        return middle + Vec3f{far * half.x * v.x, far * half.y * v.y, far * half.z * v.z};
    };
    const auto corner = [&] {
        const std::size_t t = random() % mesh.triangles.size();
        return mesh.corner(t, random() % 3);
    };
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t t = random() % mesh.triangles.size();
        const Vec3f a = mesh.corner(t, 0), b = mesh.corner(t, 1);
        rays.push_back({place(4), unit_vector(random)});
        const Vec3f from = place(3);
        rays.push_back({from, a + 0.5f * (number(random) + 1) * (b - a) - from});  // towards a point of an edge
        rays.push_back({a - 2.0f * (b - a), b - a});                               // along an edge
        rays.push_back({corner(), corner() - place(1)});
        Vec3f along{};
        (random() % 3 == 0 ? along.x : random() % 2 ? along.y : along.z) = random() % 2 ? 1.0f : -1.0f;
        rays.push_back({corner() - 3.0f * along, along});
    }
    std::erase_if(rays, [](const Ray& r) { return r.d.x == 0 && r.d.y == 0 && r.d.z == 0; });
    return rays;
}

void expect_same(const Mesh& mesh, std::size_t count) {
    const Bvh bvh(mesh.positions, mesh.triangles);
    const Affine to = bvh.to_file().inverse();
    std::size_t hits = 0;
    for (const Ray& ray : rays_about(mesh, count, 7)) {
        const Vec3f o = as<float>(to.point(widen(ray.o))), d = as<float>(to.vector(widen(ray.d)));
        for (const float t_max : {infinity, 0.7f}) {
            const TriangleHit tree = bvh.closest(o, d, t_max), all = bvh.closest_of_all(o, d, t_max);
            ASSERT_EQ(tree.triangle, all.triangle);
            ASSERT_EQ(tree.t, all.t);
            ASSERT_EQ(tree.u, all.u);
            ASSERT_EQ(tree.v, all.v);
            ASSERT_EQ(bvh.occluded(o, d, t_max), all.triangle != no_item);
            hits += all.triangle != no_item;
        }
    }
    EXPECT_GT(hits, count / 4);
}

TEST(Bvh, GivesTheBitsOfTestingEveryTriangle) {
    expect_same(sphere_mesh(24, 17), 1000);
    expect_same(test::soup_mesh(500, 0.3f, 1), 1000);
    expect_same(test::soup_mesh(500, 1e-5f, 2), 1000);  // tiny triangles far apart
    expect_same(test::placed(sphere_mesh(9, 7), {3e4f, -2e4f, 7e5f}, 12), 300);
    expect_same(test::placed(sphere_mesh(9, 7), {0, 0, 0}, 3e-12f), 300);
    Mesh flat = test::soup_mesh(300, 0.4f, 3);
    for (Vec3f& p : flat.positions) p.y = 0.25f;
    expect_same(flat, 1000);
    Mesh copies = sphere_mesh(6, 5);  // equal triangles: the least index is hit
    const std::vector<Triangle> once = copies.triangles;
    for (int k = 0; k < 40; ++k) copies.triangles.insert(copies.triangles.end(), once.begin(), once.end());
    expect_same(copies, 200);
}

TEST(Bvh, BuildsTheSameTreeOnAnyNumberOfThreads) {
    const Mesh mesh = test::soup_mesh(30000, 0.02f, 4);
    std::vector<Bounds> boxes(mesh.triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) boxes[i].add(mesh.corner(i, k));
    const BvhTree one = on_threads(1, [&] { return build_tree(boxes); }),
                  four = on_threads(4, [&] { return build_tree(boxes); });
    EXPECT_EQ(one.leaves, four.leaves);
    ASSERT_EQ(one.nodes.size(), four.nodes.size());
    for (std::size_t i = 0; i < one.nodes.size(); ++i) {
        ASSERT_EQ(std::memcmp(&one.nodes[i], &four.nodes[i], sizeof(BvhNode)), 0);
    }
    std::vector<int> found(boxes.size());
    for (const Leaf& leaf : one.leaves)
        for (const std::uint32_t item : leaf)
            if (item != no_item) ++found[item];
    EXPECT_EQ(found, std::vector<int>(boxes.size(), 1));
}

/// Each square of a grid is there twice, as for the two triangles of a quad: a leaf has two squares, leaves do not
/// overlap, and nodes are more than half full.
TEST(Bvh, DividesAGridIntoSquares) {
    constexpr std::size_t side = 128;
    std::vector<Bounds> boxes;
    for (std::size_t i = 0; i < side * side; ++i) {
        const Vec3f corner = {static_cast<float>(i % side), 0, static_cast<float>(i / side)};
        boxes.insert(boxes.end(), 2, Bounds{corner, corner + Vec3f{1, 0, 1}});
    }
    const BvhTree tree = build_tree(boxes);
    double covered = 0;
    for (const Leaf& leaf : tree.leaves) {
        Bounds box;
        for (const std::uint32_t item : leaf)
            if (item != no_item) box.add(boxes[item]);
        covered += static_cast<double>((box.high.x - box.low.x) * (box.high.z - box.low.z));
    }
    EXPECT_LT(covered, 1.1 * side * side);
    EXPECT_LT(tree.leaves.size(), 1.1 * side * side / 2);
    EXPECT_LT(tree.nodes.size(), tree.leaves.size() / 5);
}

TEST(Bvh, AnEmptyBoxAddsNothing) {
    Bounds box;
    box.add(Vec3f{1, 2, 3});
    box.add(Bounds{});
    EXPECT_EQ(box.high.x, 1);
    EXPECT_EQ(box.low.z, 3);
}

TEST(Bvh, TakesAtMostAHundredBytesPerTriangle) {
    const Mesh mesh = sphere_mesh(200, 100);
    const auto pack = make_pack(mesh);
    const auto soup = make_pack(test::soup_mesh(40000, 0.02f, 5));  // three corners of its own for each triangle
    EXPECT_LE(soup->bytes(), 101 * soup->mesh.triangles.size());
    // Without smooth normals and texture coordinates, which are 10 bytes of a triangle.
    const std::size_t shading = pack->mesh.positions.size() * (sizeof(Vec3f) + sizeof(Vec2<float>));
    EXPECT_LE(pack->bytes() - shading, 100 * pack->mesh.triangles.size());
}

TEST(Bvh, ClosedMeshesAreWatertight) {
    const Mesh mesh = sphere_mesh(61, 37);
    const Bvh bvh(mesh.positions, mesh.triangles);
    const Affine to = bvh.to_file().inverse();
    std::mt19937 random(5);
    for (int i = 0; i < 20000; ++i) {
        const Vec3f o = 0.3f * unit_vector(random);
        const std::size_t t = random() % mesh.triangles.size();
        const float w = std::uniform_real_distribution<float>(0, 1)(random);
        const Vec3f on_edge = mesh.corner(t, 0) + w * (mesh.corner(t, 1) - mesh.corner(t, 0));
        for (const Vec3f d : {unit_vector(random), on_edge - o, mesh.corner(t, 2) - o}) {
            const Vec3f from = as<float>(to.point(widen(o))), along = as<float>(to.vector(widen(d)));
            ASSERT_TRUE(bvh.occluded(from, along, infinity));
        }
    }
}

TEST(Rays, GiveTheBitsOfTestingEveryInstance) {
    const auto ball = make_pack(sphere_mesh(14, 9)), soup = make_pack(test::soup_mesh(60, 0.5f, 8));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto point = [&](double size) {
        return Vec3d{size * number(random), size * number(random), size * number(random)};
    };
    std::vector<MeshInstance> instances;
    for (int i = 0; i < 60; ++i) {
        const Affine place = translation(Vec3d{500, 0, 0} + point(8)).after(rotation(point(180)));
        const Vec3d stretch = Vec3d{1.3, 1.3, 1.3} + point(1.2);
        instances.push_back({i % 3 ? ball : soup, place.after(scaling(stretch)), i % 3});
    }
    const Rays rays(instances, {500, 0, 0});
    std::size_t hits = 0;
    for (int i = 0; i < 4000; ++i) {
        const Vec3f x = as<float>(point(12)), d = unit_vector(random);
        const float t_max = i % 2 ? infinity : 6.0f;
        const MeshHit tree = rays.closest(x, d, t_max), all = rays.closest_of_all(widen(x), widen(d), t_max);
        ASSERT_EQ(tree.instance, all.instance);
        ASSERT_EQ(tree.triangle, all.triangle);
        ASSERT_EQ(tree.t, all.t);
        ASSERT_EQ(rays.occluded(x, d, t_max), all.found());
        hits += all.found();
        if (!all.found()) continue;
        // The hit in the scene, in double precision, is where the ray says.
        const MeshInstance& hit = instances[all.instance];
        const Mesh& mesh = hit.pack->mesh;
        const auto corner = [&](std::size_t k) { return hit.to_world.point(widen(mesh.corner(all.triangle, k))); };
        const double u = static_cast<double>(all.u), v = static_cast<double>(all.v);
        const Vec3d off = (1 - u - v) * corner(0) + u * corner(1) + v * corner(2) - Vec3d{500, 0, 0} -
            (widen(x) + static_cast<double>(all.t) * widen(d));
        ASSERT_LT(std::sqrt(dot(off, off)), 1e-4);
    }
    EXPECT_GT(hits, 500u);
}

TEST(Rays, AConvexSurfaceDoesNotShadowItself) {
    const auto ball = make_pack(sphere_mesh(80, 60));
    std::mt19937 random(9);
    for (const Vec3d at : {Vec3d{0, 0, 0}, Vec3d{3, -7, 20}, Vec3d{4e3, 1e3, -2e3}})
        for (const double size : {1e-3, 1.0, 700.0}) {
            const Affine place = translation(at).after(rotation({20, 50, 80}).after(scaling({size, size, size})));
            const Rays rays({{ball, place, 0}}, {1, 2, 3});
            for (int i = 0; i < 3000; ++i) {
                const std::size_t t = random() % ball->mesh.triangles.size();
                std::uniform_real_distribution<double> number(0, 1);
                const double a = number(random), b = i % 3 ? number(random) * (1 - a) : 0;  // on an edge, too
                const auto corner = [&](std::size_t k) { return place.point(widen(ball->mesh.corner(t, k))); };
                const Vec3d e1 = corner(1) - corner(0), e2 = corner(2) - corner(0), n = normalize(cross(e1, e2));
                const Vec3d x = corner(0) + a * e1 + b * e2 - Vec3d{1, 2, 3};
                const Vec3f from = as<float>(x + rays.offset(0, x) * n);
                Vec3d d = widen(unit_vector(random));
                d = d + (i % 2 ? 1e-6 - dot(d, n) : 0) * n;  // grazing
                if (dot(d, n) < 0) d = -d;
                ASSERT_FALSE(rays.occluded(from, as<float>(d), infinity)) << size << " " << i;
            }
        }
}

}  // namespace bvh_test
}  // namespace crescent
