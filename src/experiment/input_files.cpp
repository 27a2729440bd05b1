// Images are checked for their use here, wherever they come from.
#include "experiment/input_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/counted.h"
#include "base/errors.h"
#include "base/files.h"
#include "experiment/identity.h"
#include "experiment/parser.h"
#include "scene/texture.h"

namespace crescent {

void load_sky(SkyLight& sky) {
    std::shared_ptr<const RgbImage> image = sky_in_file(sky.file, sky.layer.value_or(""));
    sky.raised_count = 0;
    if (smallest_number(*image) < 0) {
        const auto raised_image = std::make_shared<RgbImage>(*image);
        sky.raised_count = raise_to_zero(*raised_image);
        image = raised_image;
    }
    if (const std::string reason = why_no_sky(*image, sky.scale); !reason.empty())
        throw InputError({sky.file, 0, 0}, reason);
    const std::string content = content_hash(*image);
    if (sky.content && sky.content != content)
        throw InputError(
            {sky.file, 0, 0}, fmt::format("expected an image with the content {}, found {}", *sky.content, content));
    sky.content = content;
    sky.image = std::move(image);
}

std::string note_on_sky(const SkyLight& sky) {
    if (sky.raised_count == 0) return "";
    return fmt::format("sky: {}, at most {:g} % of its energy, count{} as 0",
        counted(sky.raised_count, "number[s] below 0"), 100 * negative_share, sky.raised_count == 1 ? "s" : "");
}

namespace {

/// Returns the path of a file that `experiment_file` names, which is in its folder or below.
std::string path_inside(const std::string& experiment_file, const std::string& file) {
    const std::filesystem::path folder = std::filesystem::path(experiment_file).parent_path();
    const std::string path = (folder / file).string();
    if (leads_out(folder.string(), path))
        throw InputError({path, 0, 0},
            "expected a file in the folder of the experiment or below it, found a link to "
            "another place");
    return path;
}

}  // namespace

void load_texture(Texture& texture, TextureOf property, const std::string& experiment_file) {
    if (!texture.file || texture.image) return;
    const std::string file = path_inside(experiment_file, *texture.file);
    std::shared_ptr<const RgbImage> image = texture_in_file(file);
    if (const std::string reason = why_no_texture(*image, property); !reason.empty())
        throw InputError({file, 0, 0}, reason);
    texture.image = std::move(image);
}

std::string content_of(const MeshObject& mesh) {
    ensure(mesh.pack != nullptr, "the content of a mesh is that of its file");
    std::uint64_t hash = mesh.pack->hash;
    for (const TextureKey& key : texture_keys) {
        const Texture& texture = mesh.*key.texture;
        if (!texture.image) continue;
        const std::uint64_t parts[] = {hash, texture.image->hash, key.of == TextureOf::alpha ? 1u : 0u};
        hash = XXH3_64bits(parts, sizeof parts);
    }
    return fmt::format("{:016x}", hash);
}

// ---- A file is read each time it is hashed, because it may change between two runs of one process.

std::string_view python_file(std::string_view sampler) {
    if (sampler.ends_with(".py")) return sampler;
    const std::string_view file = sampler.substr(0, sampler.rfind(':'));
    return file.ends_with(".py") ? file : std::string_view{};
}

std::string sampler_file(const ArmPlan& arm) {
    if (arm.plugin) return *arm.plugin;
    const std::optional<std::string>& python = arm.python ? arm.python : arm.combination.weights_python;
    return python ? std::string(python_file(*python)) : std::string{};
}

namespace {

/// The key of an arm that names what another program evaluates.
std::string key_of_code(const ArmPlan& arm) {
    return fmt::format("arms.{}.{}", arm.name,
        arm.exec         ? "exec"
            : arm.plugin ? "plugin"
            : arm.python ? "python"
                         : "weights_python");
}

}  // namespace

std::string sampler_file_hashes(const Experiment& experiment) {
    std::string marks;
    for (const ArmPlan& arm : experiment.arms) {
        const std::string file = sampler_file(arm);
        if (file.empty()) continue;
        if (is_no_regular_file(file)) {
            const std::string key = key_of_code(arm);
            throw InputError(experiment.place_of(key),
                fmt::format("{}: expected a regular file, found something else at '{}'", key, file));
        }
        const std::string bytes = contents_of(file);
        marks += fmt::format(" {}={:016x}", arm.name, bytes.empty() ? 0 : XXH3_64bits(bytes.data(), bytes.size()));
    }
    return marks;
}

void refuse_code(const Experiment& experiment) {
    std::vector<Diagnostic> diagnostics;
    for (const ArmPlan& arm : experiment.arms) {
        const std::optional<std::string>& weights = arm.combination.weights_python;
        if (!arm.is_external() && !weights) continue;
        const std::string path = key_of_code(arm);
        diagnostics.push_back({experiment.place_of(path),
            fmt::format("{}: with --no-code, expected a built-in sampler (key 'sampler'); found code to run: '{}'",
                path,
                arm.exec         ? *arm.exec
                    : arm.plugin ? *arm.plugin
                    : arm.python ? *arm.python
                                 : *weights)});
    }
    if (!diagnostics.empty()) throw InputError(std::move(diagnostics));
}

// ---- Reads the files of meshes and their textures. A mesh must be within 1000 km of the origin, the range of all
// coordinates.

namespace {

Vec3d corner_of(const Bounds& box, unsigned corner) {
    return widen(Vec3f{
        corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y, corner & 4 ? box.high.z : box.low.z});
}

void check_extent(const Experiment& e, const MeshObject& mesh) {
    const Bounds box = mesh.pack->mesh.bounds();
    const Affine transform = mesh.placement.transform();
    const auto check = [&](const Affine& to, const std::string& path) {
        for (unsigned corner = 0; corner < 8; ++corner) {
            const Vec3d p = to.point(corner_of(box, corner));
            if (place_range.holds(p.x) && place_range.holds(p.y) && place_range.holds(p.z)) continue;
            throw InputError(e.place_of(path),
                fmt::format(
                    "{}: expected a mesh within {} m of the origin along each axis, found a corner of its box at "
                    "({:.4g}, {:.4g}, {:.4g})",
                    path, place_range.high, p.x, p.y, p.z));
        }
    };
    const std::string path = "meshes." + mesh.name;
    if (mesh.instances.empty()) check(transform, path);
    for (std::size_t i = 0; i < mesh.instances.size(); ++i)
        check(mesh.instances[i].transform().after(transform), fmt::format("{}.instances.{}", path, i));
}

/// Whether triangles face both ends of this axis of the mesh.
bool has_two_sides(const Mesh& mesh, std::size_t axis) {
    bool ends[2] = {};
    for (std::size_t t = 0; t < mesh.triangles.size() && !(ends[0] && ends[1]); ++t) {
        const Vec3d a = widen(mesh.corner(t, 0)), b = widen(mesh.corner(t, 1)), c = widen(mesh.corner(t, 2)),
                    n = cross(b - a, c - a);
        const double components[3] = {n.x, n.y, n.z};
        if (components[axis] != 0) ends[components[axis] > 0] = true;
    }
    return ends[0] && ends[1];
}

/// The two sides of a closed emitter must be apart in single precision: a ray that leaves one of them, or meets one,
/// is known to a few steps of the coordinates. With 128 steps (2^-24 each) all arms agree; with 16 a flattened sphere
/// loses 0.5 % of its light, with two 22 %.
void check_thickness(const Experiment& e, const MeshObject& mesh) {
    if (!mesh.emits()) return;
    const Bounds box = mesh.pack->mesh.bounds();
    const auto check = [&](const Affine& to, const std::string& path) {
        double largest = 0;
        for (unsigned corner = 0; corner < 8; ++corner) {
            const Vec3d p = to.point(corner_of(box, corner));
            largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        }
        const Vec3d origin = to.point(corner_of(box, 0));
        const Vec3d edges[3] = {to.point(corner_of(box, 1)) - origin, to.point(corner_of(box, 2)) - origin,
            to.point(corner_of(box, 4)) - origin};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Vec3d normal = cross(edges[(axis + 1) % 3], edges[(axis + 2) % 3]);
            const double area = std::sqrt(dot(normal, normal));
            const double thickness = area > 0 ? std::fabs(dot(edges[axis], normal)) / area : 0;
            if (thickness <= 0 || thickness >= 128 * 0x1p-24 * largest || !has_two_sides(mesh.pack->mesh, axis))
                continue;
            throw InputError(e.place_of(path + ".scale"),
                fmt::format(
                    "{}: expected an emitter whose two sides are at least {:.2g} m apart, which single precision "
                    "needs at coordinates of {:.3g} m, found {:.2g} m",
                    path, 128 * 0x1p-24 * largest, largest, thickness));
        }
    };
    const std::string path = "meshes." + mesh.name;
    const Affine transform = mesh.placement.transform();
    if (mesh.instances.empty()) check(transform, path);
    for (std::size_t i = 0; i < mesh.instances.size(); ++i)
        check(mesh.instances[i].transform().after(transform), fmt::format("{}.instances.{}", path, i));
}

/// The product of alpha and the smallest texel is a roughness too.
void check_roughness(const Experiment& e, const MeshObject& mesh, std::vector<Diagnostic>& diagnostics) {
    const auto& image = mesh.alpha_texture.image;
    if (!image || !mesh.material.alpha) return;
    const double least_roughness = *mesh.material.alpha * static_cast<double>(smallest_number(*image));
    const std::string path = "meshes." + mesh.name + ".alpha_texture";
    if (least_roughness < least_alpha)
        diagnostics.push_back({e.place_of(path),
            fmt::format("{}: expected a roughness of at least {:g} everywhere, found alpha times the smallest texel = "
                        "{:.3g}",
                path, least_alpha, least_roughness)});
}

void check_uv(const Experiment& e, const MeshObject& mesh, std::vector<Diagnostic>& diagnostics) {
    if (!mesh.pack->mesh.uv.empty()) return;
    for (const TextureKey& key : texture_keys) {
        const std::string path = fmt::format("meshes.{}.{}", mesh.name, key.name);
        if ((mesh.*key.texture).image)
            diagnostics.push_back({e.place_of(path),
                fmt::format("{}: expected a mesh with texture coordinates, found none in '{}'", path, mesh.file)});
    }
}

}  // namespace

void read_meshes(Experiment& experiment) {
    std::vector<Diagnostic> diagnostics;
    for (MeshObject& mesh : experiment.meshes) {
        const std::string path = "meshes." + mesh.name;
        /// A mistake in a file that a key names is reported at the key, with the place in the file.
        const auto at_key = [&](const std::string& key, const auto& work) {
            try {
                work();
            } catch (const InputError& error) {
                const Diagnostic& first = error.diagnostics().front();
                const bool is_located = first.location.file == experiment.file && first.location.line > 0;
                diagnostics.push_back({is_located ? first.location : experiment.place_of(key),
                    is_located ? first.message : fmt::format("{}: {}", key, error.what())});
            }
        };
        if (!mesh.pack)
            at_key(path + ".file", [&] {
                mesh.pack = mesh_in_file(path_inside(experiment.file, mesh.file));
                check_extent(experiment, mesh);
                check_thickness(experiment, mesh);
            });
        for (const TextureKey& key : texture_keys)
            at_key(fmt::format("{}.{}", path, key.name),
                [&] { load_texture(mesh.*key.texture, key.of, experiment.file); });
        if (!mesh.pack || !diagnostics.empty()) continue;
        check_uv(experiment, mesh, diagnostics);
        check_roughness(experiment, mesh, diagnostics);
        const std::string content = content_of(mesh);
        if (mesh.content && *mesh.content != content)
            diagnostics.push_back({experiment.place_of(path + ".content"),
                fmt::format("{0}.content: expected a mesh and textures with the content {1}, found {2}", path,
                    *mesh.content, content)});
        mesh.content = content;
    }
    throw_if_any(std::move(diagnostics));
}

}  // namespace crescent
