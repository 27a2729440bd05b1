// crescent import MODEL --out FOLDER: an experiment of the whole scene. Materials of metal and roughness become
// rho_d = (1 - metal) colour, rho_s = (1 - metal) rho_s + metal colour, and alpha = roughness^2 (glTF 2.0, appendix B).
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "import.h"

namespace crescent::cli {

namespace {

/// Below it, a lobe is narrower than the error of single precision (budget).
constexpr double least_roughness = 1e-3;

Rgb colour_of(const Json& from) { return {from[0].get<double>(), from[1].get<double>(), from[2].get<double>()}; }

/// A colour that an experiment takes as an albedo.
Rgb albedo(Rgb c) {
    for (double& x : c) x = std::clamp(x, 0.0, 1.0);
    return std::ranges::max(c) < 1e-6 ? Rgb{} : c;
}

/// Averages squares of texels, until no side is longer than a texture's.
RgbImage shrunk(RgbImage image) {
    while (std::max(image.width, image.height) > widest_texture) {
        RgbImage half;
        half.width = std::max(image.width / 2, 1);
        half.height = std::max(image.height / 2, 1);
        half.rgb.resize(3 * half.texels());
        for (int y = 0; y < half.height; ++y)
            for (int x = 0; x < half.width; ++x)
                for (std::size_t c = 0; c < 3; ++c) {
                    float sum = 0;
                    for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
                        const int column = std::min(2 * x + dx, image.width - 1);
                        const int row = std::min(2 * y + dy, image.height - 1);
                        sum += image.rgb[3 *
                                (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                    static_cast<std::size_t>(column)) +
                            c];
                    }
                    half.rgb[3 *
                            (static_cast<std::size_t>(y) * static_cast<std::size_t>(half.width) +
                                static_cast<std::size_t>(x)) +
                        c] = sum / 4;
                }
        image = std::move(half);
    }
    return image;
}

Rgb mean_of(const RgbImage& image) {
    Rgb sum{};
    for (std::size_t k = 0; k < image.rgb.size(); ++k) sum[k % 3] += static_cast<double>(image.rgb[k]);
    for (double& x : sum) x /= static_cast<double>(image.texels());
    return sum;
}

/// The scene of a description, whose files are written to a stage.
class Folder {
public:
    Folder(const ImportFlags& flags, const Imported& imported)
        : flags_(flags), imported_(imported), stage_(flags.out, "import") {
        scene_.title = std::filesystem::path(flags.file).stem().string();
        for (const Json& one : imported.description["materials"]) materials_[one["index"].get<std::size_t>()] = &one;
        for (const Json& one : imported.description["meshes"]) add_mesh(one);
        add_camera();
        if (!flags.sky.empty()) add_sky();
    }

    void write() {
        const std::string text = experiment_for(scene_);
        stage_.write("experiment.toml", text);
        // It is read as `crescent run` will read it: what it refuses is an error of the model.
        try {
            (void)load(stage_.path("experiment.toml"));
        } catch (const InputError& error) {
            refuse(flags_.file,
                fmt::format("the experiment that is made of it is refused: {}", error.diagnostics().front().message));
        }
        ProgressMonitor monitor;
        stage_.commit(monitor);
    }

    std::string summary() const {
        const auto file = [&](const char* name) { return (std::filesystem::path(flags_.out) / name).string(); };
        std::string out = fmt::format("# {}: {} meshes, {} triangles, {} images\n", file("experiment.toml"),
            scene_.meshes.size(), triangles_, texture_files_.size());
        out += fmt::format("# box {} to {}\n", point_text(widen(scene_.box.low)), point_text(widen(scene_.box.high)));
        out += moved_line(imported_.description);
        out += fmt::format("# camera: {}; light: {}\n",
            scene_.camera ? "that of the file" : "one that sees the whole model", scene_.sky ? "the sky" : "a disk");
        out += fmt::format("# taken: {} materials, colours as rho_d and rho_s, roughness as alpha\n", used_.size());
        const auto taken = [&](std::size_t count, const char* what) {
            if (count > 0) out += fmt::format("# taken: {} {}\n", count, what);
        };
        taken(colours_, "images of colours, as rho_d_texture");
        taken(roughness_, "images of roughness, as alpha_texture");
        taken(copies_, "copies of meshes, as instances");
        taken(emitters_, "meshes that emit");
        out += left_out_lines(imported_.description);
        for (const auto& [what, count] : left_out_) out += fmt::format("# left out: {} {}\n", count, what);
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
        const std::string& wanted, const std::string& otherwise, std::set<std::string>& known) {
        const std::string first = table_name_of(wanted.empty() ? otherwise : wanted).substr(0, 56);
        std::string name = first;
        for (std::size_t k = 2; !known.insert(name).second; ++k) name = fmt::format("{}-{}", first, k);
        return name;
    }

    void add_mesh(const Json& from) {
        const Json& material = *materials_.at(from["material"].get<std::size_t>());
        const std::string of_material = material["name"].get<std::string>();
        const std::string own = from.value("name", "");
        ModelMesh to;
        to.name = unique_name(own.empty() ? of_material : own, "mesh", mesh_names_);
        to.file = fmt::format("meshes/{}.mesh", to.name);
        const std::string bytes(bytes_of(from));
        const std::shared_ptr<const MeshPack> pack = read_mesh(bytes, flags_.file);
        if (pack->mesh.triangles.empty()) return;
        leave_out(pack->degenerate, "triangles without area");
        leave_out(pack->duplicate, "triangles that occur twice");
        stage_.write(to.file, bytes);
        for (const Json& rows : from.value("instances", Json::array())) {
            std::array<double, 12> matrix{};
            for (std::size_t k = 0; k < matrix.size(); ++k) matrix[k] = rows[k / 4][k % 4].get<double>();
            to.instances.push_back(matrix);
            ++copies_;
        }
        add_material(material, *pack, to);
        triangles_ += pack->mesh.triangles.size() * std::max<std::size_t>(to.instances.size(), 1);
        add_box(pack->mesh.bounds(), to);
        used_.insert(from["material"].get<std::size_t>());
        emitters_ += std::ranges::max(to.emission) > 0;
        scene_.meshes.push_back(std::move(to));
    }

    void leave_out(std::size_t count, const char* what) {
        if (count > 0) left_out_[what] += count;
    }

    void add_box(const Bounds& box, const ModelMesh& mesh) {
        if (mesh.instances.empty()) return scene_.box.add(box);
        for (const std::array<double, 12>& m : mesh.instances)
            for (unsigned corner = 0; corner < 8; ++corner) {
                const double p[3] = {static_cast<double>(corner & 1 ? box.high.x : box.low.x),
                    static_cast<double>(corner & 2 ? box.high.y : box.low.y),
                    static_cast<double>(corner & 4 ? box.high.z : box.low.z)};
                float to[3] = {};
                for (std::size_t k = 0; k < 3; ++k)
                    to[k] =
                        static_cast<float>(m[4 * k] * p[0] + m[4 * k + 1] * p[1] + m[4 * k + 2] * p[2] + m[4 * k + 3]);
                scene_.box.add(Vec3f{to[0], to[1], to[2]});
            }
    }

    void add_material(const Json& from, const MeshPack& pack, ModelMesh& to) {
        const Rgb colour = colour_of(from["rho_d"]), of_lobe = colour_of(from["rho_s"]);
        double metal = std::min(from["metal"].get<double>(), 1.0);
        to.alpha = std::clamp(from["alpha"].get<double>(), least_roughness, 1.0);
        to.two_sided = from["two_sided"].get<bool>();
        to.emission = colour_of(from["emission"]);
        if (std::ranges::max(to.emission) < 1e-9) to.emission = {};
        Rgb mean{1, 1, 1};
        const bool has_uv = !pack.mesh.uv.empty();
        for (const char* key : {"colours", "surface"})
            if (from.contains(key) && !has_uv) ++left_out_["images of parts without texture coordinates"];
        if (const Json* picture = picture_of(from, "colours", has_uv))
            if (const auto texture = texture_of(*picture, from["colours"].get<std::size_t>(), {})) {
                to.rho_d_texture = texture->file;
                mean = texture->mean;
                ++colours_;
            }
        if (const Json* picture = picture_of(from, "surface", has_uv))
            if (const auto texture = texture_of(*picture, from["surface"].get<std::size_t>(), to.alpha)) {
                to.alpha_texture = texture->file;
                metal *= texture->mean[2];
                ++roughness_;
            }
        for (std::size_t c = 0; c < 3; ++c) {
            to.rho_d[c] = (1 - metal) * colour[c];
            to.rho_s[c] = (1 - metal) * of_lobe[c] + metal * colour[c] * mean[c];
        }
        to.rho_d = albedo(to.rho_d);
        for (std::size_t c = 0; c < 3; ++c) to.rho_s[c] = std::min(to.rho_s[c], 1 - to.rho_d[c]);
        to.rho_s = albedo(to.rho_s);
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
        const auto [known, is_new] = textures_.try_emplace({index, alpha.value_or(0)});
        if (!is_new) return known->second;
        std::optional<RgbImage> image = decoded(picture, alpha.has_value());
        if (!image) return std::nullopt;
        known->second = {"", mean_of(*image)};
        if (alpha)
            for (std::size_t k = 0; k < image->rgb.size(); k += 3) {
                const double roughness = static_cast<double>(image->rgb[k + 1]);
                const double texel = std::clamp(sqr(roughness), least_roughness / *alpha, 1.0);
                for (std::size_t c = 0; c < 3; ++c) image->rgb[k + c] = static_cast<float>(texel);
            }
        const std::string stem = std::filesystem::path(picture["name"].get<std::string>()).stem().string();
        const std::string name = unique_name(stem, "image", texture_files_);
        known->second->file = fmt::format("textures/{}.exr", name);
        write_texture(stage_.path(known->second->file), *image);
        return known->second;
    }

    std::optional<RgbImage> decoded(const Json& picture, bool linear) {
        const std::string_view bytes = bytes_of(picture);
        if (bytes.empty()) {
            ++left_out_["images that are not there"];
            return std::nullopt;
        }
        const std::string name = picture["name"].get<std::string>();
        const std::string file = (std::filesystem::path(stage_.scratch()) / "picture").string() +
            std::filesystem::path(name).extension().string().substr(0, 8);
        write_whole(file, std::string(bytes));
        try {
            const Render render = read_render(
                file, {}, {.encoding = linear ? ImageEncoding::linear : ImageEncoding::automatic, .channel = {}});
            RgbImage out;
            out.width = render.width;
            out.height = render.height;
            out.rgb.resize(3 * out.texels());
            const std::vector<float>* planes[] = {&render.r, &render.g, &render.b};
            const auto width = static_cast<std::size_t>(out.width), height = static_cast<std::size_t>(out.height);
            for (std::size_t y = 0; y < height; ++y)
                for (std::size_t x = 0; x < width; ++x)
                    for (std::size_t c = 0; c < 3; ++c)
                        out.rgb[3 * (y * width + x) + c] =
                            std::clamp((*planes[c])[(height - 1 - y) * width + x], 0.0f, 1.0f);
            return shrunk(std::move(out));
        } catch (const InputError&) {
            ++left_out_["images of a format that is not read"];
            return std::nullopt;
        }
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
        const Vec3d middle = 0.5 * (widen(scene_.box.low) + widen(scene_.box.high));
        const Vec3d diagonal = widen(scene_.box.high) - widen(scene_.box.low);
        const double depth = std::max(dot(middle - eye, view), 0.1 * std::sqrt(dot(diagonal, diagonal)));
        scene_.camera = Camera{.eye = eye, .target = eye + depth * view, .up = up, .vfov_deg = from["vfov_deg"]};
        const double aspect = from["aspect"].get<double>();
        if (aspect > 0.1 && aspect < 10) scene_.aspect = aspect;
    }

    void add_sky() {
        const std::string name = "sky" + std::filesystem::path(flags_.sky).extension().string();
        SkyLight sky{.file = flags_.sky};
        load_sky(sky);  // refused with the place in the reader's own file
        stage_.write(name, contents_of(flags_.sky));
        scene_.sky = name;
    }

    const ImportFlags& flags_;
    const Imported& imported_;
    Staging stage_;
    ModelScene scene_;
    std::map<std::size_t, const Json*> materials_;
    std::map<std::pair<std::size_t, double>, std::optional<WrittenTexture>> textures_;
    std::set<std::string> mesh_names_, texture_files_;
    std::set<std::size_t> used_;
    std::map<std::string, std::size_t> left_out_;
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
