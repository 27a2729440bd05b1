// crescent import: starts crescent-import, which reads a model in a process of its own, checks the mesh that
// it wrote, and prints the tables of an experiment for it. A model that the importer dies of is an error of the input.
// An OpenEXR image is packed by the program itself.
#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "commands.h"
#include "import.h"
#include "import_material.h"

namespace crescent::cli {

namespace {

constexpr const char* importer_name = "crescent-import";
constexpr std::size_t longest_description = std::size_t{16} << 20;  // bytes
constexpr std::size_t longest_name = 200, longest_line = 500;       // characters

/// The importer next to this program, otherwise the one in PATH.
std::string importer() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    const std::filesystem::path neighbour = program.parent_path() / importer_name;
    if (!error && std::filesystem::exists(neighbour, error)) return neighbour.string();
    const char* path = std::getenv("PATH");
    for (std::string_view folders = path ? path : ""; !folders.empty();) {
        const std::size_t end = std::min(folders.find(':'), folders.size());
        const std::filesystem::path file = std::filesystem::path(folders.substr(0, end)) / importer_name;
        if (std::filesystem::exists(file, error)) return file.string();
        folders.remove_prefix(std::min(end + 1, folders.size()));
    }
    throw not_built("crescent import");
}

std::string contents_of_descriptor(int file) {
    std::string out;
    const off_t size = ::lseek(file, 0, SEEK_END);
    if (size <= 0 || ::lseek(file, 0, SEEK_SET) != 0) return out;
    out.resize(static_cast<std::size_t>(size));
    std::size_t position = 0;
    while (position < out.size()) {
        const ssize_t n = ::read(file, out.data() + position, out.size() - position);
        if (n <= 0) return {};
        position += static_cast<std::size_t>(n);
    }
    return out;
}

Json options_of(const ImportFlags& flags, bool is_folder) {
    Json out = {{"folder", is_folder}, {"up", flags.up}, {"scale", flags.scale}};
    if (!flags.material.empty()) out["material"] = flags.material;
    if (!flags.select.empty()) out["select"] = flags.select;
    if (flags.smooth) out["smooth"] = *flags.smooth;
    return out;
}

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

}  // namespace

void refuse(const std::string& file, const std::string& message) { throw InputError({file, 0, 0}, message); }

Imported import_model(const ImportFlags& flags, bool is_folder) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> mesh(std::tmpfile(), &std::fclose);
    if (!mesh) throw OutputError("cannot create a temporary file for the mesh");
    ProcessPlan plan{.argv = {importer_name, flags.file, std::to_string(flags.memory_mib),
                         fmt::format("{}", std::ceil(flags.timeout)), options_of(flags, is_folder).dump()}};
    plan.file = importer();
    plan.stdin_file = plan.stderr_file = "/dev/null";
    plan.shared = ::fileno(mesh.get());
    Process process(plan);
    const auto begin = std::chrono::steady_clock::now();
    const auto left_ms = [&] {
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
        return static_cast<int>(std::min(1e3 * (flags.timeout - seconds.count()), 1e9));
    };
    std::string text;
    std::optional<ProcessEnd> end;
    for (;;) {
        if (left_ms() <= 0)
            refuse(flags.file, fmt::format("the importer takes more than {} s (--timeout)", flags.timeout));
        char part[4096];
        if (!process.wait_ready(false, true, std::min(left_ms(), 100)).output) continue;
        const ssize_t n = process.read(part, sizeof part);
        if (n == 0) break;
        if (n > 0) text.append(part, static_cast<std::size_t>(n));
        if (text.size() > longest_description)
            refuse(
                flags.file, fmt::format("expected names and materials of at most {} MiB", longest_description >> 20));
    }
    end = process.ended(std::max(left_ms(), 0));
    if (!end) refuse(flags.file, fmt::format("the importer takes more than {} s (--timeout)", flags.timeout));
    Json description = Json::parse(text, nullptr, false);
    if (description.is_object() && description.contains("error") && description["error"].is_string())
        refuse(flags.file, printable(description["error"].get<std::string>(), 1000));
    if (!end->well() || !description.is_object())
        refuse(flags.file, fmt::format("expected a model that can be read; the importer ended with {}", end->text()));
    return {contents_of_descriptor(plan.shared), std::move(description)};
}

std::string point_text(Vec3d v) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x, v.y, v.z); }

std::string moved_line(const Json& description) {
    if (!description.contains("moved")) return "";
    const Json& offset = description["moved"];
    const double scale = description["scaled"].get<double>();
    return fmt::format("# moved by [{:.9g}, {:.9g}, {:.9g}]{}: an experiment holds sizes of 1e-3 to 1e5 m\n",
        offset[0].get<double>(), offset[1].get<double>(), offset[2].get<double>(),
        scale == 1 ? "" : fmt::format(", then scaled by {:.9g}", scale));
}

namespace {

/// The material of one mesh: that of this name, or the only one. None: several.
const Json* material_of_mesh(const Json& description, const std::string& name) {
    const auto materials = description.find("materials");
    if (materials == description.end()) return nullptr;
    for (const Json& material : *materials)
        if (material.value("name", "") == name || (name.empty() && materials->size() == 1)) return &material;
    return nullptr;
}

/// The keys of its table; without a material, a grey diffuse surface. Adds comment lines to the notes.
std::string material_keys(const Imported& imported, const ImportFlags& flags, bool has_uv, std::string& notes) {
    const auto colour = [](const Rgb& c) { return fmt::format("[{:.7g}, {:.7g}, {:.7g}]", c[0], c[1], c[2]); };
    const Json* from = material_of_mesh(imported.description, flags.material);
    if (!from) return fmt::format("rho_d = {}\n", colour({0.5, 0.5, 0.5}));
    const std::filesystem::path folder = std::filesystem::absolute(flags.out).parent_path();
    std::map<std::size_t, std::string> missing_images, unread_images;
    const auto mean_of_image = [&](const char* key, bool is_linear) {
        if (!from->contains(key) || !has_uv) return Rgb{1, 1, 1};
        const auto index = (*from)[key].get<std::size_t>();
        const Json& picture = imported.description["pictures"][index];
        const std::string_view bytes =
            std::string_view(imported.files)
                .substr(picture["begin"].get<std::size_t>(), picture["size"].get<std::size_t>());
        const std::string name = picture["name"].get<std::string>();
        Staging scratch((folder / ".crescent-import").string(), "import");
        std::optional<RgbImage> image;
        if (!bytes.empty()) image = decoded_image(bytes, name, is_linear, scratch.scratch());
        if (!image) (bytes.empty() ? missing_images : unread_images)[index] = name;
        if (image && !is_linear && states_other_encoding(bytes))
            notes += fmt::format("# assumed: {}\n", counted(1, stated_encoding));
        return image ? mean_of(*image) : Rgb{1, 1, 1};
    };
    Counts cuts;
    const ImportedMaterial material =
        material_of(*from, mean_of_image("colours", false), mean_of_image("surface", true)[2], cuts);
    notes += left_out_images(missing_images, unread_images) + cut_lines(cuts);
    std::string out = fmt::format("rho_d = {}\n", colour(material.rho_d));
    if (std::ranges::max(material.rho_s) > 0)
        out += fmt::format("rho_s = {}\nbrdf = \"ggx\"\nalpha = {:.4g}\n", colour(material.rho_s), material.alpha);
    if (std::ranges::max(material.emission) > 0) {
        out += fmt::format("emission = {}\n", colour(material.emission));
        if ((*from)["two_sided"].get<bool>()) out += "two_sided = true\n";
    }
    return out;
}

/// Comment lines, one for each entry, with the number of those beyond the hundredth.
std::string list_of(const Json& entries, const std::function<std::string(const Json&)>& line) {
    constexpr std::size_t most_lines = 100;
    std::string out;
    for (std::size_t k = 0; k < std::min(entries.size(), most_lines); ++k) out += "# " + line(entries[k]) + "\n";
    if (entries.size() > most_lines) out += fmt::format("# and {} more\n", entries.size() - most_lines);
    return out;
}

}  // namespace

std::string assumed_lines(const Json& description) {
    return list_of(description.value("assumed", Json::array()),
        [](const Json& what) { return "assumed: " + printable(what.get<std::string>(), longest_line); });
}

std::string left_out_lines(const Json& description) {
    return list_of(description.value("left_out", Json::array()),
        [](const Json& what) { return "left out: " + printable(what.get<std::string>(), longest_line); });
}

namespace {

/// Packs an image, for a sky or a texture.
int import_image(const ImportFlags& flags) {
    if (!flags.out.ends_with(".image")) refuse(flags.out, "expected a name that ends with .image (--out)");
    can_write(flags.out);
    const std::shared_ptr<const RgbImage> image = read_texture(flags.file, flags.layer);
    write_whole(flags.out, image_file(*image));
    print(fmt::format("# {}: {} x {} texels, hash {}\n", flags.out, image->width, image->height, content_hash(*image)));
    return passed;
}

}  // namespace

int import(const ImportFlags& flags) {
    const std::string extension = lower(std::filesystem::path(flags.file).extension().string());
    const std::vector<std::string> extensions = {".obj", ".ply", ".glb", ".gltf", ".stl"};
    if (extension == ".exr" || extension == ".hdr") return import_image(flags);
    if (std::ranges::find(extensions, extension) == extensions.end())
        refuse(flags.file,
            "expected a model with the extension .obj, .ply, .glb, .gltf or .stl, or an image .exr or .hdr");
    if (!flags.layer.empty() && flags.sky.empty())
        throw InputError({"--layer", 0, 0}, "expected together with --sky, or with an image as FILE");
    if (std::error_code ignored; !std::filesystem::is_regular_file(flags.file, ignored))
        refuse(flags.file, "expected a file that can be read");
    if (!flags.out.ends_with(".mesh")) return import_folder(flags);
    if (!flags.sky.empty()) refuse(flags.out, "expected a folder (--out) for an experiment with a sky (--sky)");
    can_write(flags.out);
    const Imported imported = import_model(flags, false);
    const std::string bytes = imported.files.substr(0, imported.description["mesh"]["size"].get<std::size_t>());
    const auto pack = read_mesh(bytes, flags.file);
    write_whole(flags.out, bytes);

    const Mesh& mesh = pack->mesh;
    const Bounds box = mesh.bounds();
    std::string out = fmt::format("# {}: {}, {}, hash {:016x}\n", flags.out,
        counted(mesh.triangles.size(), "triangle[s]"), counted(mesh.positions.size(), "vert[ex|ices]"), pack->hash);
    out += fmt::format("# box {} to {}\n", point_text(widen(box.low)), point_text(widen(box.high)));
    out += fmt::format("# normals: {}; texture coordinates: {}\n", mesh.normals.empty() ? "of the triangles" : "smooth",
        mesh.uv.empty() ? "none" : "one set");
    out += moved_line(imported.description);
    if (pack->degenerate > 0)
        out += fmt::format("# left out: {}\n", counted(pack->degenerate, "triangle[s] without area"));
    if (pack->duplicate > 0)
        out += fmt::format("# left out: {}\n", counted(pack->duplicate, "triangle[s] that occur[s|] twice"));
    out += assumed_lines(imported.description);
    out += left_out_lines(imported.description);
    Json materials = imported.description.value("materials", Json::array());
    if (materials.size() == 1 && materials[0].value("name", "").empty()) materials.clear();  // there is no choice
    out += list_of(materials, [&](const Json& material) {
        return fmt::format("material '{}': {}{}{}", printable(material.value("name", ""), longest_name),
            counted(material.value("triangles", std::size_t{0}), "triangle[s]"),
            material.contains("texture") ? ", texture " + printable(material.value("texture", ""), longest_name) : "",
            materials.size() > 1 && flags.material.empty() ? " (alone: --material NAME)" : "");
    });
    std::string notes;
    const std::string keys = material_keys(imported, flags, !mesh.uv.empty(), notes);
    out += notes + "\n" + camera_table(ModelPoints(mesh));
    out += fmt::format("\n[meshes.{}]\nfile = \"{}\"\n{}", table_name_of(flags.out),
        std::filesystem::path(flags.out).filename().string(), keys);
    print(out);
    return passed;
}

}  // namespace crescent::cli
