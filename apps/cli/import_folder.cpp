// crescent import MODEL --out FOLDER: an experiment of the whole scene.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <xxhash.h>

#include "import.h"
#include "import_material.h"

namespace crescent::cli {

namespace {

/// Of the files of an import, a line each: XXH3 of the content, and the name.
constexpr const char* hashes_name = ".crescent_import_hashes";

std::string hash_of(std::string_view bytes) { return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size())); }

/// The scene of a description, whose files are written to a stage.
class Folder {
public:
    Folder(const ImportFlags& flags, const Imported& imported)
        : flags_(flags), imported_(imported), stage_(flags.out, "import") {
        scene_.title = std::filesystem::path(flags.file).stem().string();
        for (const Json& material : imported.description["materials"])
            materials_[material["index"].get<std::size_t>()] = &material;
        for (const Json& mesh : imported.description["meshes"]) add_mesh(mesh);
        add_camera();
        if (!flags.sky.empty()) add_sky();
    }

    void write() {
        const std::string text = experiment_for(scene_);
        stage_.write("experiment.toml", text);
        file_names_.emplace_back("experiment.toml");
        // It is read as `crescent run` will read it: what it refuses is an error of the model.
        try {
            (void)load(stage_.path("experiment.toml"));
        } catch (const InputError& error) {
            refuse(flags_.file,
                fmt::format("the experiment that is made of it is refused: {}", error.diagnostics().front().message));
        }
        keep_edited();
        stage_.commit(monitor_);
    }

    std::string summary() {
        const auto file = [&](const char* name) { return (std::filesystem::path(flags_.out) / name).string(); };
        std::string out =
            fmt::format("# {}: {}, {}, {}\n", file("experiment.toml"), counted(scene_.meshes.size(), "mesh[es]"),
                counted(triangles_, "triangle[s]"), counted(texture_files_.size(), "image[s]"));
        out += fmt::format("# box {} to {}\n", point_text(widen(scene_.points.box().low)),
            point_text(widen(scene_.points.box().high)));
        out += moved_line(imported_.description);
        out += fmt::format("# camera: {}; light: {}\n",
            scene_.camera       ? "that of the file"
                : sees_nothing_ ? "one that sees the whole model; that of the file sees nothing of it"
                                : "one that sees the whole model",
            scene_.sky ? "the sky" : "a disk");
        const auto add_line = [&](std::size_t count, const char* what) {
            if (count > 0) out += fmt::format("# taken: {}\n", counted(count, what));
        };
        add_line(mesh_materials_.size(), "material[s], colours as rho_d and rho_s, roughness as alpha");
        add_line(colours_, "image[s] of colours, as rho_d_texture");
        add_line(roughness_, "image[s] of roughness, as alpha_texture");
        add_line(copies_, "cop[y|ies] of meshes, as [an instance|instances]");
        add_line(emitters_, "mesh[es] that emit[s|]");
        out += assumed_lines(imported_.description);
        if (other_encodings_ > 0) out += fmt::format("# assumed: {}\n", counted(other_encodings_, stated_encoding));
        if (!sky_note_.empty()) out += "# " + sky_note_ + "\n";
        out += left_out_lines(imported_.description);
        out += cut_lines(cuts_);
        for (const std::string& line : backup_lines_) out += "# " + printable(line) + "\n";
        for (const std::string& line : monitor_.take_lines()) out += "# " + printable(line) + "\n";
        for (const auto& [what, count] : omissions_) out += fmt::format("# left out: {}\n", counted(count, what));
        out += left_out_images(missing_images_, unread_images_);
        return out +
            fmt::format(
                "crescent run {} --out out/{}\n", shell_word(file("experiment.toml")), table_name_of(flags_.out));
    }

private:
    std::string_view bytes_of(const Json& place) const {
        return std::string_view(imported_.files)
            .substr(place["begin"].get<std::size_t>(), place["size"].get<std::size_t>());
    }
    static std::string unique_name(
        const std::string& title, const std::string& fallback, std::set<std::string>& names) {
        const std::string first = table_name_of(title.empty() ? fallback : title).substr(0, 56);
        std::string name = first;
        for (std::size_t k = 2; !names.insert(name).second; ++k) name = fmt::format("{}-{}", first, k);
        return name;
    }

    void add_mesh(const Json& from) {
        const Json& material = *materials_.at(from["material"].get<std::size_t>());
        const std::string material_name = material["name"].get<std::string>();
        const std::string mesh_name = from.value("name", "");
        ModelMesh to;
        to.name = unique_name(mesh_name.empty() ? material_name : mesh_name, "mesh", mesh_names_);
        to.file = fmt::format("meshes/{}.mesh", to.name);
        const std::string bytes(bytes_of(from));
        const std::shared_ptr<const MeshPack> pack = read_mesh(bytes, flags_.file);
        if (pack->mesh.triangles.empty()) return;
        leave_out(pack->degenerate, "triangle[s] without area");
        leave_out(pack->duplicate, "triangle[s] that occur[s|] twice");
        stage_.write(to.file, bytes);
        file_names_.push_back(to.file);
        for (const Json& rows : from.value("instances", Json::array())) {
            std::array<double, 12> matrix{};
            for (std::size_t k = 0; k < matrix.size(); ++k) matrix[k] = rows[k / 4][k % 4].get<double>();
            to.instances.push_back(matrix);
            ++copies_;
        }
        add_material(material, *pack, to);
        triangles_ += pack->mesh.triangles.size() * std::max<std::size_t>(to.instances.size(), 1);
        add_points(pack->mesh, to);
        mesh_materials_.insert(from["material"].get<std::size_t>());
        emitters_ += std::ranges::max(to.emission) > 0;
        scene_.meshes.push_back(std::move(to));
    }

    /// Files of an earlier import that have changed since are kept as NAME.~1~; the hashes of all files are stored.
    void keep_edited() {
        namespace fs = std::filesystem;
        const fs::path out(flags_.out);
        std::map<std::string, std::string> earlier_hashes, new_hashes;
        std::istringstream lines(contents_of((out / hashes_name).string()));
        for (std::string hash, name; lines >> hash && std::getline(lines >> std::ws, name);)
            if (hash != "#") earlier_hashes[name] = hash;
        for (const std::string& name : file_names_) new_hashes[name] = hash_of(contents_of(stage_.path(name)));
        // Earlier versions stored no hashes, but the names.
        std::istringstream names(contents_of((out / ".crescent-import").string()));
        for (std::string name; std::getline(names, name);)
            if (!name.starts_with('#') && name != hashes_name) earlier_hashes.try_emplace(name, "");
        for (const auto& [name, hash] : earlier_hashes) {
            std::error_code ignored;
            const fs::path file = out / name;
            if (!fs::is_regular_file(fs::symlink_status(file, ignored))) continue;
            const std::string current_hash = hash_of(contents_of(file.string()));
            const auto entry = new_hashes.find(name);
            if (current_hash == hash || (entry != new_hashes.end() && current_hash == entry->second)) continue;
            if (hash.empty() && entry == new_hashes.end()) continue;
            const fs::path backup = free_backup_name(file);
            if (!fs::copy_file(file, backup, ignored))
                throw OutputError(
                    fmt::format("{} has changed since crescent import wrote it, and cannot be copied to {}",
                        file.string(), backup.string()));
            backup_lines_.push_back(fmt::format("{} has changed since crescent import wrote it: it is now {}",
                file.string(), backup.filename().string()));
        }
        std::string text = "# What crescent import wrote; a file that has changed since is kept as NAME.~1~.\n";
        for (const auto& [name, hash] : new_hashes) text += fmt::format("{} {}\n", hash, name);
        stage_.write(hashes_name, text);
    }

    void leave_out(std::size_t count, const char* what) {
        if (count > 0) omissions_[what] += count;
    }

    void add_points(const Mesh& points, const ModelMesh& mesh) {
        if (mesh.instances.empty()) return scene_.points.add(points);
        const Bounds box = points.bounds();
        for (const std::array<double, 12>& m : mesh.instances)
            for (unsigned corner = 0; corner < 8; ++corner) {
                const double p[3] = {static_cast<double>(corner & 1 ? box.high.x : box.low.x),
                    static_cast<double>(corner & 2 ? box.high.y : box.low.y),
                    static_cast<double>(corner & 4 ? box.high.z : box.low.z)};
                double to[3] = {};
                for (std::size_t k = 0; k < 3; ++k)
                    to[k] = m[4 * k] * p[0] + m[4 * k + 1] * p[1] + m[4 * k + 2] * p[2] + m[4 * k + 3];
                scene_.points.add(Vec3d{to[0], to[1], to[2]});
            }
    }

    void add_material(const Json& from, const MeshPack& pack, ModelMesh& to) {
        to.two_sided = from["two_sided"].get<bool>();
        const double alpha = std::clamp(from["alpha"].get<double>(), least_imported_alpha(), 1.0);
        Rgb mean{1, 1, 1};
        double mean_metal = 1;
        const bool has_uv = !pack.mesh.uv.empty();
        if (const Json* picture = picture_of(from, "colours", has_uv))
            if (const auto texture = texture_of(*picture, from["colours"].get<std::size_t>(), {})) {
                to.rho_d_texture = texture->file;
                mean = texture->mean;
                ++colours_;
            }
        if (const Json* picture = picture_of(from, "surface", has_uv))
            if (const auto texture = texture_of(*picture, from["surface"].get<std::size_t>(), alpha)) {
                to.alpha_texture = texture->file;
                mean_metal = texture->mean[2];
                ++roughness_;
            }
        const bool is_first_use = materials_taken_.insert(from["index"].get<std::size_t>()).second;
        Counts earlier_counts;  // a material that several meshes have is counted once
        const ImportedMaterial material = material_of(from, mean, mean_metal, is_first_use ? cuts_ : earlier_counts);
        to.rho_d = material.rho_d;
        to.rho_s = material.rho_s;
        to.emission = material.emission;
        to.alpha = material.alpha;
    }
    const Json* picture_of(const Json& material, const char* key, bool has_uv) const {
        if (!has_uv || !material.contains(key)) return nullptr;
        return &imported_.description["pictures"][material[key].get<std::size_t>()];
    }

    struct WrittenTexture {
        std::string file;
        Rgb mean;  // of the image
    };
    /// Writes an image: colours, or, with the alpha that it multiplies, the squares of its green channel. Nothing if it
    /// cannot be read.
    std::optional<WrittenTexture> texture_of(const Json& picture, std::size_t index, std::optional<double> alpha) {
        const auto [entry, is_new] = textures_.try_emplace({index, alpha.value_or(0)});
        std::optional<WrittenTexture>& texture = entry->second;
        if (!is_new) return texture;
        std::optional<RgbImage> image = decoded(picture, index, alpha.has_value());
        if (!image) return std::nullopt;
        texture = WrittenTexture{"", mean_of(*image)};
        if (alpha)
            for (std::size_t k = 0; k < image->rgb.size(); k += 3) {
                const double roughness = static_cast<double>(image->rgb[k + 1]);
                const double texel = std::clamp(sqr(roughness), least_imported_alpha() / *alpha, 1.0);
                for (std::size_t c = 0; c < 3; ++c) image->rgb[k + c] = static_cast<float>(texel);
            }
        const std::string stem = std::filesystem::path(picture["name"].get<std::string>()).stem().string();
        const std::string name = unique_name(stem, "image", texture_files_);
        texture->file = fmt::format("textures/{}.exr", name);
        write_texture(stage_.path(texture->file), *image);
        file_names_.push_back(texture->file);
        return texture;
    }

    std::optional<RgbImage> decoded(const Json& picture, std::size_t index, bool is_linear) {
        const std::string_view bytes = bytes_of(picture);
        const std::string name = picture["name"].get<std::string>();
        std::optional<RgbImage> out;
        if (!bytes.empty()) out = decoded_image(bytes, name, is_linear, stage_.scratch());
        if (!out) (bytes.empty() ? missing_images_ : unread_images_)[index] = name;
        other_encodings_ += out && !is_linear && states_other_encoding(bytes);
        return out;
    }

    /// A camera looks at the depth of the middle of the model.
    void add_camera() {
        const Json& description = imported_.description;
        if (!description.contains("camera")) return;
        const Json& from = description["camera"];
        const auto vector = [&](const char* key) {
            return Vec3d{from[key][0].get<double>(), from[key][1].get<double>(), from[key][2].get<double>()};
        };
        const Vec3d eye = vector("eye"), view = normalize(vector("view")), up = normalize(vector("up"));
        const Vec3d middle = 0.5 * (widen(scene_.points.box().low) + widen(scene_.points.box().high));
        const Vec3d diagonal = widen(scene_.points.box().high) - widen(scene_.points.box().low);
        const double depth = std::max(dot(middle - eye, view), 0.1 * std::sqrt(dot(diagonal, diagonal)));
        const Camera camera{.eye = eye, .target = eye + depth * view, .up = up, .vfov_deg = from["vfov_deg"]};
        const double stated_aspect = from["aspect"].get<double>();
        const double aspect = stated_aspect > 0.1 && stated_aspect < 10 ? stated_aspect : scene_.aspect;
        sees_nothing_ = !scene_.points.may_be_seen(camera, aspect);
        if (sees_nothing_) return;
        scene_.camera = camera;
        scene_.aspect = aspect;
    }

    void add_sky() {
        const std::string name = "sky" + std::filesystem::path(flags_.sky).extension().string();
        SkyLight sky{.file = flags_.sky};
        if (!flags_.layer.empty()) sky.layer = flags_.layer;
        load_sky(sky);  // refused with the place in the reader's own file
        sky_note_ = note_on_sky(sky);
        stage_.write(name, contents_of(flags_.sky));
        file_names_.push_back(name);
        scene_.sky = name;
        scene_.sky_layer = flags_.layer;
    }

    const ImportFlags& flags_;
    const Imported& imported_;
    Staging stage_;
    PolledMonitor monitor_;
    std::vector<std::string> file_names_, backup_lines_;  // names of files; lines on what was kept
    ModelScene scene_;
    std::map<std::size_t, const Json*> materials_;
    std::map<std::pair<std::size_t, double>, std::optional<WrittenTexture>> textures_;
    std::set<std::string> mesh_names_, texture_files_;
    std::set<std::size_t> mesh_materials_;
    std::set<std::size_t> materials_taken_;
    Counts omissions_, cuts_;
    std::map<std::size_t, std::string> missing_images_, unread_images_;  // images, by their indices
    std::size_t other_encodings_ = 0;                                    // images
    std::string sky_note_;
    bool sees_nothing_ = false;  // the file's camera
    std::size_t triangles_ = 0, copies_ = 0, colours_ = 0, roughness_ = 0, emitters_ = 0;
};

}  // namespace

int import_folder(const ImportFlags& flags) {
    const std::filesystem::path out(flags.out);
    if (out.has_extension() && !std::filesystem::is_directory(out))
        refuse(flags.out, "expected a folder, or a name that ends with .mesh (--out)");
    const Imported imported = import_model(flags, true);
    Folder folder(flags, imported);
    folder.write();
    print(folder.summary());
    return passed;
}

}  // namespace crescent::cli
