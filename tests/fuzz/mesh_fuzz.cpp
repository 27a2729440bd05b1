// Any bytes as a .mesh file: it is read, or rejected with an InputError that has a message. The hash is made right
// first, since no mutation would guess it. A mesh that is read gives the same hits with its tree as without.
#include <cstdint>
#include <cstring>
#include <string>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/errors.h"
#include "scene/mesh/mesh.h"

namespace {

using namespace crescent;

constexpr std::size_t header_size = 40, hash_at = 32;

void keeps_its_promises(const MeshPack& pack) {
    const Mesh& mesh = pack.mesh;
    ensure(!mesh.triangles.empty(), "a mesh has triangles");
    ensure(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(), "a normal for each position");
    ensure(mesh.uv.empty() || mesh.uv.size() == mesh.positions.size(), "texture coordinates for each position");
    for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t k : triangle) ensure(k < mesh.positions.size(), "an index is one of a position");
    const Vec3f rays[] = {{0, 0, 1}, {1, 0, 0}, {0.3f, -0.8f, 0.2f}, {-1e-20f, 1, 0}};
    for (const Vec3f d : rays)
        for (const Vec3f o : {Vec3f{}, Vec3f{-3 * d.x, -3 * d.y, -3 * d.z}, Vec3f{0.1f, 0.2f, 0.3f}}) {
            const TriangleHit tree = pack.bvh.closest(o, d, infinity), all = pack.bvh.closest_of_all(o, d, infinity);
            ensure(tree.triangle == all.triangle && tree.t == all.t, "the tree changes no hit");
            ensure(pack.bvh.occluded(o, d, infinity) == (all.triangle != no_item), "a hit occludes");
        }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string file(reinterpret_cast<const char*>(data), size);
    if (size > header_size) {
        const std::uint64_t hash = XXH3_64bits(file.data() + header_size, size - header_size);
        std::memcpy(&file[hash_at], &hash, sizeof hash);
    }
    try {
        keeps_its_promises(*read_mesh(file, "fuzz.mesh"));
    } catch (const InputError& error) {
        ensure(!error.diagnostics().empty() && !error.diagnostics().front().message.empty(), "a refusal says why");
    }
    return 0;
}
