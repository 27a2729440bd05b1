// Lengths in the meshes' own unit, radiance in W/(sr m^2).
#include "experiment/model_experiment.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

#include "experiment/identity.h"
#include "math/simd/math.h"
#include "math/simd/scalar.h"

namespace crescent {

namespace {

/// The ball around a box.
struct Ball {
    Vec3d middle;
    double radius;
    explicit Ball(const Bounds& box)
        : middle(0.5 * (widen(box.low) + widen(box.high))), radius(0.5 * length(widen(box.high) - widen(box.low))) {}

private:
    static double length(Vec3d v) { return std::sqrt(dot(v, v)); }
};

/// A disk that the ball sees as large as 0.2 sr from above and the left, and even light from everywhere else.
std::string light_over(const Ball& ball) {
    const Vec3d light_direction = normalize(Vec3d{-0.6, 1, 0.6});
    return fmt::format(
        "[disks.light]\ncenter = {}\nnormal = {}\nradius = {:.6g}\nradiance = [15, 15, 15]\n\n[fill]\nradiance = "
        "[0.3, 0.3, 0.3]\n",
        point_in_table(ball.middle + 2.5 * ball.radius * light_direction, ball.radius),
        point_in_table(-1.0 * light_direction, 1), 0.6 * ball.radius);
}

std::string sky_table(const std::string& file, const std::string& layer = "") {
    return fmt::format(
        "[sky]\nfile = {}\n{}", toml_text(file), layer.empty() ? "" : fmt::format("layer = {}\n", toml_text(layer)));
}

std::string arm(const std::string& name) { return fmt::format("[arms.{}]\nn = [4, 16, 64]\n\n", name); }

}  // namespace

std::string table_name_of(const std::string& file) {
    std::string name = std::filesystem::path(file).stem().string();
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
    if (name.empty() || name[0] == '-') name = "mesh" + name;
    return name.substr(0, 64);
}

std::string experiment_for(const std::vector<NamedMesh>& meshes, const std::optional<std::string>& sky) {
    constexpr int width = 240, height = 180;
    ModelPoints points;
    for (const auto& [file, pack] : meshes) points.add(pack->mesh);
    const std::string first = std::filesystem::path(meshes.at(0).first).stem().string();
    std::string out = fmt::format(
        "title = \"{}\"\nn = 64\n\n[image]\nwidth = {}\nheight = {}\n\n", table_name_of(first), width, height);
    out += camera_table(points, static_cast<double>(width) / height) + "\n";
    for (const auto& [file, pack] : meshes)
        out += fmt::format(
            "[meshes.{}]\nfile = \"{}\"\nrho_d = [0.3, 0.25, 0.2]\nrho_s = 0.4\nbrdf = \"ggx\"\nalpha = 0.2\n\n",
            table_name_of(file), file);
    out += sky ? sky_table(*sky) : light_over(Ball(points.box()));
    out += "\n[reference]\nn = 32\n\n";
    out += arm("cosine") + arm("material") + arm("renderer");
    return out + "[regions.all]\n";
}

namespace {

/// Seven digits, so that the sum of rho_d and rho_s is 1 if it was.
std::string colour(const Rgb& c) { return fmt::format("[{:.7g}, {:.7g}, {:.7g}]", c[0], c[1], c[2]); }

std::string mesh_table(const ModelMesh& mesh) {
    std::string out =
        fmt::format("[meshes.{}]\nfile = \"{}\"\nrho_d = {}\nrho_s = {}\nbrdf = \"ggx\"\nalpha = {:.4g}\n", mesh.name,
            mesh.file, colour(mesh.rho_d), colour(mesh.rho_s), mesh.alpha);
    if (!mesh.rho_d_texture.empty()) out += fmt::format("rho_d_texture = \"{}\"\n", mesh.rho_d_texture);
    if (!mesh.alpha_texture.empty()) out += fmt::format("alpha_texture = \"{}\"\n", mesh.alpha_texture);
    if (std::ranges::max(mesh.emission) > 0)
        out += fmt::format("emission = {}\n{}", colour(mesh.emission), mesh.two_sided ? "two_sided = true\n" : "");
    for (const std::array<double, 12>& m : mesh.instances) {
        out += fmt::format("\n[[meshes.{}.instances]]\nmatrix = [", mesh.name);
        for (std::size_t k = 0; k < m.size(); ++k)
            out += fmt::format("{}{:.9g}", k > 0 ? ", " : "", m[k] + 0);  // -0 becomes 0
        out += "]\n";
    }
    return out + "\n";
}

}  // namespace

std::string experiment_for(const ModelScene& scene) {
    constexpr int width = 320;
    const int height = std::clamp(static_cast<int>(std::lround(width / scene.aspect)), 80, 640);
    const Ball ball(scene.points.box());
    std::string out = fmt::format(
        "title = \"{}\"\nn = 64\n\n[image]\nwidth = {}\nheight = {}\n\n", table_name_of(scene.title), width, height);
    if (scene.camera)
        out += fmt::format("[camera]\neye = {}\ntarget = {}\nup = {}\nvfov_deg = {:.6g}\n\n",
            point_in_table(scene.camera->eye, ball.radius), point_in_table(scene.camera->target, ball.radius),
            point_in_table(scene.camera->up, 1), scene.camera->vfov_deg);
    else out += camera_table(scene.points, scene.aspect) + "\n";
    for (const ModelMesh& mesh : scene.meshes) out += mesh_table(mesh);
    out += scene.sky ? sky_table(*scene.sky, scene.sky_layer) : light_over(ball);
    out += "\n[reference]\nn = 64\n\n";
    out += arm("cosine") + arm("material") + (scene.sky ? arm("sky") : "") + arm("renderer");
    out += "[regions.all]\n\n";
    for (const char* name : {"material", "renderer"})
        out += fmt::format("[plates.{0}]\nkind = \"ladder\"\nruns = [{{ arm = \"{0}\" }}]\n\n", name);
    return out;
}

}  // namespace crescent
