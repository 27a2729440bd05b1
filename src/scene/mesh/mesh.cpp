// Reads and writes the .mesh file, and removes useless triangles. The counts of the file are compared with its size
// before anything is allocated, so that memory is bounded by that size.
#include "scene/mesh/mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <utility>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/errors.h"

namespace crescent {

namespace {

static_assert(std::endian::native == std::endian::little, "mesh files are little-endian");
static_assert(sizeof(Vec3f) == 12 && sizeof(Vec2<float>) == 8 && sizeof(Triangle) == 12);

constexpr std::uint32_t mesh_kind = 0x6873656d, mesh_version = 1, with_normals = 1, with_uv = 2;
constexpr float farthest = 1e30f;  // so that no product of three coordinates in normalised space overflows

struct Header {
    char magic[8];
    std::uint32_t kind, version, vertices, triangles, flags, reserved;
    std::uint64_t hash;
};
static_assert(sizeof(Header) == mesh_header_size);

template <class T> void append(std::string& to, const std::vector<T>& values) {
    if (!values.empty()) to.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// Reads the header of a file of `size` bytes and checks all of it but the hash.
Header checked_header(std::string_view head, std::uint64_t size, const std::string& name) {
    const auto fail = [&](const std::string& message) { throw InputError({name, 0, 0}, message); };
    Header header{};
    if (head.size() < sizeof header)
        fail(fmt::format("expected a .mesh file, whose header has {} bytes; found {} bytes", sizeof header, size));
    std::memcpy(&header, head.data(), sizeof header);
    if (std::memcmp(header.magic, "crescent", 8) != 0 || header.kind != mesh_kind)
        fail("expected a .mesh file (it begins with \"crescentmesh\"); `crescent import` makes one of a model");
    if (header.version != mesh_version)
        fail(fmt::format("byte 12: expected version {} of the .mesh format, found {}", mesh_version, header.version));
    if (header.flags > (with_normals | with_uv))
        fail(fmt::format("byte 24: expected flags from 0 to {}, found {}", with_normals | with_uv, header.flags));
    if (header.reserved != 0) fail(fmt::format("byte 28: expected 0, found {}", header.reserved));
    if (header.vertices == 0 || header.triangles == 0)
        fail(fmt::format("byte 16: expected at least a triangle, found {} vertices and {} triangles", header.vertices,
            header.triangles));
    const std::uint64_t of_vertex = 12u + (header.flags & with_normals ? 12u : 0u) + (header.flags & with_uv ? 8u : 0u);
    const std::uint64_t expected_size =
        sizeof header + header.vertices * of_vertex + std::uint64_t{12} * header.triangles;
    if (expected_size != size)
        fail(fmt::format("expected {} bytes for {} vertices and {} triangles, found {}{}", expected_size,
            header.vertices, header.triangles, size, size < expected_size ? ": the file is truncated" : ""));
    if (header.triangles >= std::uint32_t{1} << 30)
        fail(fmt::format("byte 20: expected fewer than 2^30 triangles, found {}", header.triangles));
    return header;
}

class Reader {
public:
    Reader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    Mesh operator()(std::uint64_t& hash) {
        const Header header = with_content();
        hash = header.hash;
        Mesh mesh;
        take(mesh.positions, header.vertices);
        if (header.flags & with_normals) take(mesh.normals, header.vertices);
        if (header.flags & with_uv) take(mesh.uv, header.vertices);
        take(mesh.triangles, header.triangles);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) position(i, mesh.positions[i]);
        for (std::size_t i = 0; i < mesh.normals.size(); ++i) normal(i, mesh.normals[i]);
        for (std::size_t i = 0; i < mesh.uv.size(); ++i)
            if (!std::isfinite(mesh.uv[i].x) || !std::isfinite(mesh.uv[i].y))
                fail(fmt::format(
                    "vertex {}: expected finite texture coordinates, found ({}, {})", i, mesh.uv[i].x, mesh.uv[i].y));
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
            for (const std::uint32_t k : mesh.triangles[i])
                if (k >= header.vertices)
                    fail(
                        fmt::format("triangle {}: expected indices from 0 to {}, found {}", i, header.vertices - 1, k));
        return mesh;
    }

    [[noreturn]] void fail(const std::string& message) const { throw InputError({name_, 0, 0}, message); }

private:
    Header with_content() {
        Header header = checked_header(bytes_, bytes_.size(), name_);
        const std::uint64_t hash = XXH3_64bits(bytes_.data() + sizeof header, bytes_.size() - sizeof header);
        if (header.hash != 0 && hash != header.hash)
            fail(fmt::format("byte 32: expected the hash of the content, {:016x}, found {:016x}: the file is damaged",
                hash, header.hash));
        header.hash = hash;
        offset_ = sizeof header;
        return header;
    }

    template <class T> void take(std::vector<T>& to, std::size_t count) {
        to.resize(count);
        std::memcpy(to.data(), bytes_.data() + offset_, count * sizeof(T));
        offset_ += count * sizeof(T);
    }

    void position(std::size_t i, Vec3f p) const {
        const auto is_good = [](float x) { return std::fabs(x) <= farthest; };
        if (!is_good(p.x) || !is_good(p.y) || !is_good(p.z))
            fail(fmt::format(
                "vertex {}: expected coordinates from -1e30 to 1e30, found ({}, {}, {})", i, p.x, p.y, p.z));
    }

    void normal(std::size_t i, Vec3f n) const {
        const double length = std::sqrt(dot(widen(n), widen(n)));
        if (!(std::fabs(length - 1) <= 1e-3))
            fail(fmt::format(
                "vertex {}: expected a unit normal, found ({}, {}, {}) of length {:.4g}", i, n.x, n.y, n.z, length));
    }

    std::string_view bytes_;
    const std::string& name_;
    std::size_t offset_ = 0;
};

}  // namespace

namespace {

std::string content_of(const Mesh& mesh) {
    std::string content;
    append(content, mesh.positions);
    append(content, mesh.normals);
    append(content, mesh.uv);
    append(content, mesh.triangles);
    return content;
}

}  // namespace

std::uint64_t hash_of(const Mesh& mesh) {
    const std::string content = content_of(mesh);
    return XXH3_64bits(content.data(), content.size());
}

std::string mesh_file(const Mesh& mesh) {
    const std::string content = content_of(mesh);
    Header header{.magic = {},
        .kind = mesh_kind,
        .version = mesh_version,
        .vertices = static_cast<std::uint32_t>(mesh.positions.size()),
        .triangles = static_cast<std::uint32_t>(mesh.triangles.size()),
        .flags = (mesh.normals.empty() ? 0 : with_normals) | (mesh.uv.empty() ? 0 : with_uv),
        .reserved = 0,
        .hash = XXH3_64bits(content.data(), content.size())};
    std::memcpy(header.magic, "crescent", 8);
    std::string out(sizeof header, '\0');
    std::memcpy(out.data(), &header, sizeof header);
    return out += content;
}

std::uint32_t read_triangle_count(std::string_view head, std::uint64_t size, const std::string& name) {
    return checked_header(head, size, name).triangles;
}

std::shared_ptr<const MeshPack> read_mesh(std::string_view bytes, const std::string& name) {
    Reader reader(bytes, name);
    std::uint64_t hash = 0;
    Mesh mesh = reader(hash);
    const std::size_t triangles_read = mesh.triangles.size();
    const std::shared_ptr<MeshPack> pack = make_pack(std::move(mesh));
    if (pack->mesh.triangles.empty())
        reader.fail(fmt::format("expected a triangle with an area, found {} without", triangles_read));
    pack->hash = hash;
    return pack;
}

// ---- Bounds and the removal of useless triangles. A triangle without area is one whose corners repeat or lie on a
// line: the cross product of two edges, in double precision, is 0.

namespace {

using Key = std::array<float, 9>;  // corners in an order of their own

Key key_of(const Mesh& mesh, std::size_t triangle) {
    std::array<std::array<float, 3>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f p = mesh.corner(triangle, k);
        corners[k] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // -0 becomes 0
    }
    std::sort(corners.begin(), corners.end());
    Key key;
    for (std::size_t k = 0; k < 3; ++k)
        std::copy_n(corners[k].begin(), 3, key.begin() + static_cast<std::ptrdiff_t>(3 * k));
    return key;
}

/// FNV-1a over words.
std::uint64_t hash_of(const Key& key) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const float x : key) {
        hash = (hash ^ std::bit_cast<std::uint32_t>(x)) * 0x100000001b3;
        hash ^= hash >> 29;
    }
    return hash;
}

bool has_area(const Mesh& mesh, std::size_t triangle) {
    const Vec3d a = widen(mesh.corner(triangle, 0));
    const Vec3d n = cross(widen(mesh.corner(triangle, 1)) - a, widen(mesh.corner(triangle, 2)) - a);
    return n.x != 0 || n.y != 0 || n.z != 0;
}

}  // namespace

Bounds Mesh::bounds() const {
    Bounds box;
    for (const Triangle& triangle : triangles)
        for (const std::uint32_t k : triangle) box.add(positions[k]);
    return box;
}

Removed remove_useless(Mesh& mesh) {
    const std::size_t count = mesh.triangles.size();
    std::vector<bool> is_useless(count);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    order.reserve(count);
    Removed counts;
    for (std::size_t i = 0; i < count; ++i) {
        if (!has_area(mesh, i)) {
            is_useless[i] = true;
            ++counts.degenerate;
        } else order.emplace_back(hash_of(key_of(mesh, i)), static_cast<std::uint32_t>(i));
    }
    std::sort(order.begin(), order.end());
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && order[end].first == order[begin].first) ++end;
        for (std::size_t i = begin + 1; i < end; ++i) {
            const bool is_duplicate = std::any_of(order.begin() + static_cast<std::ptrdiff_t>(begin),
                order.begin() + static_cast<std::ptrdiff_t>(i),
                [&, key = key_of(mesh, order[i].second)](
                    const auto& other) { return !is_useless[other.second] && key_of(mesh, other.second) == key; });
            if (is_duplicate) {
                is_useless[order[i].second] = true;
                ++counts.duplicate;
            }
        }
    }
    std::size_t triangle_count = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (!is_useless[i]) mesh.triangles[triangle_count++] = mesh.triangles[i];
    mesh.triangles.resize(triangle_count);
    return counts;
}

std::shared_ptr<MeshPack> make_pack(Mesh mesh) {
    auto pack = std::make_shared<MeshPack>();
    const Removed counts = remove_useless(mesh);
    pack->degenerate = counts.degenerate;
    pack->duplicate = counts.duplicate;
    pack->bvh = Bvh(mesh.positions, mesh.triangles);
    pack->hash = hash_of(mesh);
    pack->mesh = std::move(mesh);
    return pack;
}

std::size_t MeshPack::bytes() const {
    return bvh.bytes() + mesh.positions.size() * sizeof(Vec3f) + mesh.triangles.size() * sizeof(Triangle) +
        mesh.normals.size() * sizeof(Vec3f) + mesh.uv.size() * sizeof(Vec2<float>);
}

}  // namespace crescent
