// The .mesh file: what is written is read again, and every kind of damage is an InputError that says what and where,
// before memory is taken for it.
#include "scene/mesh/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/errors.h"
#include "tests/support/meshes.h"

namespace crescent {
namespace mesh_test {

using testing::HasSubstr;

constexpr std::size_t header_size = 40;

template <class T> void put(std::string& file, std::size_t at, T value) {
    std::memcpy(&file[at], &value, sizeof value);
}

/// Makes the hash right again after a change of the content.
void seal(std::string& file) {
    put(file, 32, static_cast<std::uint64_t>(XXH3_64bits(file.data() + header_size, file.size() - header_size)));
}

TEST(MeshFile, IsReadAsItWasWritten) {
    Mesh mesh = test::sphere_mesh(12, 7);
    for (const bool bare : {false, true}) {
        if (bare) {
            mesh.normals.clear();
            mesh.uv.clear();
        }
        const std::string file = mesh_file(mesh);
        const auto pack = read_mesh(file, "ball.mesh");
        EXPECT_EQ(mesh_file(pack->mesh), file);
        EXPECT_EQ(pack->degenerate + pack->duplicate, 0u);
        EXPECT_EQ(pack->hash, make_pack(mesh)->hash);
    }
}

TEST(MeshFile, LeavesOutTrianglesWithoutAreaAndCopies) {
    Mesh mesh = test::sphere_mesh(8, 5);
    const std::size_t count = mesh.triangles.size();
    const Triangle first = mesh.triangles[0];
    mesh.triangles.push_back({first[1], first[2], first[0]});  // the same, turned
    mesh.triangles.push_back({first[0], first[2], first[1]});  // from behind
    mesh.positions.push_back(mesh.positions[first[0]]);        // the same place, another index
    mesh.normals.push_back({0, 1, 0});
    mesh.uv.push_back({});
    mesh.triangles.push_back({static_cast<std::uint32_t>(mesh.positions.size() - 1), first[1], first[2]});
    mesh.triangles.push_back({first[0], first[0], first[1]});  // two corners
    const auto pack = read_mesh(mesh_file(mesh), "ball.mesh");
    EXPECT_EQ(pack->mesh.triangles.size(), count);
    EXPECT_EQ(pack->duplicate, 3u);
    EXPECT_EQ(pack->degenerate, 1u);
}

TEST(MeshFile, RefusesDamageWithThePlace) {
    const std::string good = mesh_file(test::sphere_mesh(8, 5));
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    const std::size_t vertices = 48, normals = header_size + vertices * 12, uv = normals + vertices * 12,
                      triangles = uv + vertices * 8;
    struct Case {
        std::function<void(std::string&)> damage;
        const char* says;
        bool sealed = true;
    };
    const Case cases[] = {{[](std::string& f) { f.clear(); }, "found 0 bytes", false},
        {[](std::string& f) { f.resize(39); }, "found 39 bytes", false},
        {[](std::string& f) { f[0] = 'x'; }, "expected a .mesh file", false},
        {[](std::string& f) { put(f, 8, 7); }, "expected a .mesh file", false},
        {[](std::string& f) { put(f, 12, 2); }, "byte 12: expected version 1", false},
        {[](std::string& f) { put(f, 24, 4); }, "byte 24: expected flags", false},
        {[](std::string& f) { put(f, 28, 1); }, "byte 28", false},
        {[](std::string& f) { put(f, 20, 0); }, "at least a triangle", false},
        {[](std::string& f) {
             f.resize(1000);
             put(f, 20, 100000000);
         },
            "truncated", false},
        {[](std::string& f) {
             put(f, 16, 0xffffffffu);
             put(f, 20, 0xffffffffu);
         },
            "truncated", false},
        {[](std::string& f) { f.pop_back(); }, "truncated", false},
        {[](std::string& f) { f += 'x'; }, "expected", false},
        {[](std::string& f) { f.back() ^= 1; }, "byte 32: expected the hash", false},
        {[&](std::string& f) { put(f, header_size + 12 * 5 + 4, nan); }, "vertex 5: expected coordinates"},
        {[&](std::string& f) { put(f, header_size + 12 * 6, infinite); }, "vertex 6: expected coordinates"},
        {[&](std::string& f) { put(f, header_size, 1e38f); }, "vertex 0: expected coordinates"},
        {[&](std::string& f) { put(f, normals + 12 * 7, nan); }, "vertex 7: expected a unit normal"},
        {[&](std::string& f) { put(f, normals, 3.0f); }, "vertex 0: expected a unit normal"},
        {[&](std::string& f) { put(f, uv + 8 * 9, infinite); }, "vertex 9: expected finite texture"},
        {[&](std::string& f) { put(f, triangles + 12 * 3, 48); },
            "triangle 3: expected indices from 0 to 47, found 48"},
        {[&](std::string& f) { std::memset(&f[triangles], 0, f.size() - triangles); },
            "expected a triangle with an area"}};
    for (const Case& c : cases) {
        std::string file = good;
        c.damage(file);
        if (c.sealed) seal(file);
        try {
            static_cast<void>(read_mesh(file, "bad.mesh"));
            ADD_FAILURE() << "read in spite of: " << c.says;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr(c.says));
            EXPECT_EQ(error.diagnostics().front().location.file, "bad.mesh");
        }
    }
}

}  // namespace mesh_test
}  // namespace crescent
