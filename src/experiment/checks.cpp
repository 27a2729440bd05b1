// Checks that involve several values: names that must exist, boxes on the image, the camera's direction, shapes with an
// extent, light.
#include "experiment/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "experiment/combinations.h"
#include "experiment/experiment.h"
#include "experiment/input_files.h"
#include "experiment/parser.h"
#include "experiment/value.h"
#include "samplers/info.h"

namespace crescent {

namespace {

constexpr double parallel = 1e-6;  // sine of the angle under which two directions count as one

double length(Vec3d v) { return std::sqrt(dot(v, v)); }

/// Whether a relative path has a part "..".
bool leaves_folder(const std::filesystem::path& path) {
    return std::ranges::any_of(path, [](const std::filesystem::path& part) { return part == ".."; });
}

template <class T> std::vector<std::string> names_of(const std::vector<T>& items) {
    std::vector<std::string> names;
    for (const T& item : items) names.push_back(item.name);
    return names;
}

void check_camera(ParseContext& context) {
    const Camera& c = context.e.camera;
    if (!context.is_valid("camera") || !context.is_valid("camera.eye") || !context.is_valid("camera.target")) return;
    const Vec3d view = c.target - c.eye;
    if (length(view) < 1e-9)
        return context.report("camera.target", "camera.target: expected a point other than camera.eye, found the same");
    if (context.is_valid("camera.up") && length(cross(view, c.up)) < parallel * length(view))
        context.report(
            "camera.up", "camera.up: expected a direction that is not parallel to the view from eye to target");
}

void check_box_on_image(ParseContext& context, const std::string& path, const Box& box) {
    const Image& image = context.e.image;
    if (!context.is_valid(path) || !context.is_valid("image") || !context.is_valid("image.width") ||
        !context.is_valid("image.height"))
        return;
    if (box.x0 >= 0 && box.y0 >= 0 && box.x1 < image.width && box.y1 < image.height) return;
    context.report(path,
        fmt::format("{}: expected a box on the image, x from 0 to {} and y from 0 to {}, found [{}, {}, {}, {}]", path,
            image.width - 1, image.height - 1, box.x0, box.y0, box.x1, box.y1),
        Diagnostic::Kind::box_off_image);
}

/// Checks the parameters of a kind against each other, if all of them could be read.
template <class Any> void check_form(ParseContext& context, const std::string& path, const Any& any) {
    if (!context.is_valid(path + ".kind")) return;
    std::visit(
        [&]<class Kind>(const Kind& kind) {
            if constexpr (requires { kind.mistake(); }) {
                for (const Parameter<Kind>& parameter : Kind::parameters())
                    if (!context.is_valid(fmt::format("{}.{}", path, parameter.name))) return;
                if (const std::optional<Mistake> mistake = kind.mistake()) {
                    const std::string key = fmt::format("{}.{}", path, mistake->key);
                    context.report(key, fmt::format("{}: {}", key, mistake->says));
                }
            }
        },
        any);
}

void check_material(ParseContext& context, std::size_t surface) {
    const std::string path = context.e.surface_path(surface);
    const Material& m = context.e.material(surface);
    if (!context.is_valid(path + ".brdf") || !(m.rho_s > 0)) return;
    const LobeInfo& lobe = lobe_info(m.brdf);
    const bool takes_alpha = lobe.parameter == LobeParameter::alpha;
    if (takes_alpha && !m.alpha && context.is_valid(path + ".alpha"))
        context.report(path + ".alpha",
            fmt::format("missing key 'alpha' in [{}]: expected the roughness of its {} lobe, from 0.0001 to 1", path,
                lobe.name));
    if (!takes_alpha && !m.s && context.is_valid(path + ".s"))
        context.report(path + ".s",
            fmt::format(
                "missing key 's' in [{}]: expected the exponent of its lobe (rho_s > 0), a number above 0", path));
}

/// Kernels square a radiance times an albedo in single precision, whose smallest normal number is 1e-38: the square of
/// the smallest product, 1e-15, leaves eight digits for the weight of a sample.
constexpr double least_radiance = 1e-9, least_albedo = 1e-6;

/// Reports a colour whose largest channel is above 0 and below `limit`.
void check_not_lost(ParseContext& context, const std::string& path, const Rgb& color, double limit) {
    const double largest = std::ranges::max(color);
    if (largest <= 0 || largest >= limit || !context.is_valid(path)) return;
    context.report(path,
        fmt::format("{}: expected 0, or a largest channel of at least {:g}, found {:g}, whose square is lost in single "
                    "precision",
            path, limit, largest));
}

void check_magnitudes(ParseContext& context) {
    const Experiment& e = context.e;
    check_not_lost(context, "fill.radiance", e.fill, least_radiance);
    for (const DiskLight& disk : e.disks)
        check_not_lost(context, "disks." + disk.name + ".radiance", disk.radiance, least_radiance);
    for (const Light& light : e.lights)
        check_not_lost(context, "lights." + light.name + ".radiance", light.radiance, least_radiance);
    for (const MeshObject& mesh : e.meshes)
        check_not_lost(context, "meshes." + mesh.name + ".emission", mesh.emission, least_radiance);
    for (std::size_t k = 0; k < e.surface_count(); ++k) {
        const Material& m = e.material(k);
        check_not_lost(context, e.surface_path(k) + ".rho_d", m.rho_d, least_albedo);
        check_not_lost(context, e.surface_path(k) + ".rho_s", {m.rho_s, m.rho_s, m.rho_s}, least_albedo);
    }
}

/// What an arm reaches: a combination reaches what any of its samplers reaches; a sampler whose code is not built in
/// counts as reaching everything. Combinations that contain themselves are reported elsewhere.
Reaches reaches_of(const Experiment& e, const std::string& name, std::set<std::string>& visited_arms) {
    Reaches out{.fill = false, .lights = false, .sky = false, .triangles = false};
    const ArmPlan* arm = e.find_arm(name);
    if (arm && arm->is_combination()) {
        if (!visited_arms.insert(name).second) return out;
        for (const std::string& part : arm->combination.of) {
            const Reaches part_reaches = reaches_of(e, part, visited_arms);
            out.fill |= part_reaches.fill;
            out.lights |= part_reaches.lights;
            out.sky |= part_reaches.sky;
            out.triangles |= part_reaches.triangles;
        }
        return out;
    }
    const SamplerInfo* info = arm && arm->is_external() ? nullptr : find_arm_info(arm ? arm->sampler : name);
    return info ? info->reaches : Reaches{};
}

/// Reports an arm whose samplers reach no light that the experiment has: every sample of it is 0.
void check_reached_light(ParseContext& context) {
    for (const char* table : {"disks", "lights", "fill", "fill.radiance", "sky", "meshes", "arms"})
        if (!context.is_valid(table)) return;
    const Experiment& e = context.e;
    const auto shines = [](const auto& light) { return std::ranges::max(light.radiance) > 0; };
    const bool has_lights = std::ranges::any_of(e.disks, shines) || std::ranges::any_of(e.lights, shines),
               has_triangles = std::ranges::any_of(e.meshes, &MeshObject::emits),
               has_fill = std::ranges::max(e.fill) > 0;
    for (const ArmPlan& arm : e.arms) {
        std::set<std::string> visited_arms;
        const Reaches reaches = reaches_of(e, arm.name, visited_arms);
        if ((reaches.fill && has_fill) || (reaches.lights && has_lights) || (reaches.triangles && has_triangles) ||
            (reaches.sky && e.sky))
            continue;
        std::string reached_lights;
        for (const auto& [is_reached, name] :
            {std::pair(reaches.fill, "the fill"), {reaches.lights, "disks and lights"},
                {reaches.triangles, "triangles that emit"}, {reaches.sky, "a sky"}})
            if (is_reached) reached_lights += (reached_lights.empty() ? "" : " and ") + std::string(name);
        if (reached_lights.empty()) continue;  // a combination of nothing, which is reported elsewhere
        context.report("arms." + arm.name,
            fmt::format("arms.{}: {} only {}, and the experiment has no such light: every sample would be 0", arm.name,
                arm.is_combination() ? fmt::format("the samplers {} reach", fmt::join(arm.combination.of, ", "))
                                     : fmt::format("the sampler '{}' reaches", arm.sampler),
                reached_lights));
    }
}

void check_content(ParseContext& context, const std::string& path, const std::optional<std::string>& content) {
    if (!content || !context.is_valid(path)) return;
    if (content->size() == 16 && content->find_first_not_of("0123456789abcdef") == std::string::npos) return;
    context.report(path,
        fmt::format("{}: expected 16 hexadecimal digits in lower case, found \"{}\"", path, content->substr(0, 64)));
}

void check_light(ParseContext& context) {
    const auto& disks = context.e.disks;
    const auto& lights = context.e.lights;
    if (const std::size_t light_count = disks.size() + lights.size(); light_count > most_lights)
        context.report(disks.size() > most_lights ? "disks." + disks[most_lights].name
                                                  : "lights." + lights[most_lights - disks.size()].name,
            fmt::format("disks and lights: expected at most {}, found {}", most_lights, light_count));
    if (const auto& sky = context.e.sky; sky && context.is_valid("sky.file") && sky->file.empty())
        context.report("sky.file", "sky.file: expected the name of a file, found an empty text");
    if (const auto& sky = context.e.sky; sky && sky->layer && sky->layer->empty())
        context.report("sky.layer", "sky.layer: expected the name of a layer, found an empty text");
    if (const auto& sky = context.e.sky) check_content(context, "sky.content", sky->content);
    for (const Light& light : lights) check_form(context, "lights." + light.name, light.form);
    const Rgb& fill = context.e.fill;
    const auto is_dark = [](const auto& light) {
        return light.radiance[0] + light.radiance[1] + light.radiance[2] <= 0;
    };
    const bool is_unlit = std::all_of(disks.begin(), disks.end(), is_dark) &&
        std::all_of(lights.begin(), lights.end(), is_dark) &&
        std::ranges::none_of(context.e.meshes, [](const MeshObject& mesh) { return mesh.emits(); });
    if (is_unlit && !context.e.sky && context.is_valid("meshes") && context.is_valid("disks") &&
        context.is_valid("lights") && context.is_valid("fill") && context.is_valid("fill.radiance") &&
        fill[0] + fill[1] + fill[2] <= 0)
        context.report(
            "fill.radiance", "no light: expected a disk, a light or the fill with a radiance above 0, or a sky");
}

void check_external_arms(ParseContext& context) {
    for (const ArmPlan& arm : context.e.arms) {
        const std::string path = "arms." + arm.name;
        const std::array keys = {
            std::pair("exec", arm.exec), std::pair("plugin", arm.plugin), std::pair("python", arm.python)};
        const auto key_count = std::ranges::count_if(keys, [](const auto& key) { return key.second.has_value(); });
        if (key_count + int(!arm.sampler.empty()) + int(arm.is_combination()) > 1)
            context.report(
                path, fmt::format("{}: expected one of sampler, kind, exec, plugin and python, found several", path));
        if (arm.python && !arm.python->empty() && python_file(*arm.python).empty() &&
            arm.python->find(':') == std::string::npos)
            context.report(path + ".python",
                fmt::format("{}.python: expected \"FILE.py:NAME\", \"FILE.py\" or \"module:NAME\", found \"{}\"", path,
                    *arm.python));
        for (const auto& [key, text] : keys)
            if (text && text->empty())
                context.report(path + "." + key, fmt::format("{}.{}: expected a text, found an empty one", path, key));
    }
}

void check_meshes(ParseContext& context) {
    const Experiment& e = context.e;
    if (e.shapes.empty() && e.meshes.empty() && context.is_valid("shapes") && context.is_valid("meshes"))
        context.report("shapes", "missing tables [shapes.NAME] or [meshes.NAME]: expected what the camera sees");
    for (const MeshObject& mesh : e.meshes) {
        const std::string path = "meshes." + mesh.name;
        const auto check = [&](const Placement& placement, const std::string& owner) {
            for (const char* key : {".scale", ".rotate", ".translate", ".matrix"})
                if (!context.is_valid(owner + key)) return;
            for (const char* key : {".scale", ".rotate", ".translate"})
                if (placement.matrix && e.places.contains(owner + key))
                    context.report(owner + key,
                        fmt::format("{}{}: expected a matrix, or scale, rotate and translate; found both", owner, key));
            if (const double volume = placement.transform().det(); !(std::fabs(volume) > 1e-18))
                context.report(owner + (placement.matrix ? ".matrix" : ".scale"),
                    fmt::format(
                        "{}: expected a transform that keeps a volume, found a determinant of {:.3g}", owner, volume));
        };
        check(mesh.placement, path);
        for (std::size_t i = 0; i < mesh.instances.size(); ++i)
            check(mesh.instances[i], fmt::format("{}.instances.{}", path, i));
        const auto check_file = [&](const std::string& key, const std::filesystem::path& file) {
            if (context.is_valid(key) && (file.empty() || file.is_absolute() || leaves_folder(file)))
                context.report(key,
                    fmt::format("{}: expected a file in the folder of the experiment or below it, found '{}'", key,
                        file.string()));
        };
        check_file(path + ".file", mesh.file);
        for (const TextureKey& key : texture_keys)
            if (const auto& file = (mesh.*key.texture).file) check_file(fmt::format("{}.{}", path, key.name), *file);
        check_content(context, path + ".content", mesh.content);
    }
}

/// Whether an arm's name is no sampler because its kind is missing or wrong, which is reported by itself.
bool is_unfinished_combination(const ParseContext& context, const std::string& path_of_sampler) {
    const std::string path = path_of_sampler.substr(0, path_of_sampler.rfind('.'));
    const ArmPlan* arm = context.e.find_arm(path.substr(path.find('.') + 1));
    return arm && (!context.is_valid(path + ".kind") || !arm->combination.of.empty());
}

/// A furnace has one material, so its mesh has no texture of a number that counts.
void check_furnaces(ParseContext& context) {
    for (const FurnacePlan& furnace : context.e.furnaces) {
        const auto mesh = std::ranges::find(context.e.meshes, furnace.shape, &MeshObject::name);
        if (mesh == context.e.meshes.end()) continue;
        for (const TextureKey& key : texture_keys) {
            const bool counts = key.of == TextureOf::alpha || furnace.part != FurnacePart::lobe;
            if (!counts || !((*mesh).*key.texture).file) continue;
            const std::string path = "furnaces." + furnace.name + ".shape";
            context.report(path,
                fmt::format(
                    "{}: expected a surface of one material, found '{}', which has {}", path, mesh->name, key.name));
        }
    }
}

/// Checks that no two arms write their films into one file.
void check_film_files(ParseContext& context) {
    const Experiment& e = context.e;
    std::map<std::string, std::string, std::less<>> owners = {{std::string(reference_file), "the references"}};
    if (e.exponent)
        for (const double s : e.exponent->s)
            if (s != e.s())
                owners.emplace(film_file(e.exponent->arm, s, e.s()), fmt::format("{} at s = {}", e.exponent->arm, s));
    for (const ArmPlan& arm : e.arms)
        if (const auto owner = owners.find(arm.name); owner != owners.end())
            context.report("arms." + arm.name,
                fmt::format("arms.{}: films/{}.exr is where those of {} go: expected another name", arm.name, arm.name,
                    owner->second));
}

}  // namespace

void check_geometry(ParseContext& context) {
    check_camera(context);
    for (const Shape& shape : context.e.shapes) check_form(context, "shapes." + shape.name, shape.form);
    for (std::size_t k = 0; k < context.e.surface_count(); ++k) check_material(context, k);
    check_meshes(context);
    for (const Region& region : context.e.regions)
        check_box_on_image(context, "regions." + region.name + ".box", region.box);
    for (const PlatePlan& plate : context.e.plates)
        if (plate.crop) check_box_on_image(context, "plates." + plate.name + ".crop", *plate.crop);
    check_light(context);
    check_magnitudes(context);
}

void check_names(ParseContext& context) {
    const std::vector<std::string> arms = names_of(context.e.arms), shapes = context.e.surface_names();
    for (const Reference& r : context.references) {
        const bool is_arm = r.type == Type::arm, is_sampler = r.type == Type::sampler;
        if (is_sampler && is_unfinished_combination(context, r.path)) continue;
        const std::vector<std::string> valid = is_sampler ? sampler_words() : is_arm ? arms : shapes;
        if (std::count(valid.begin(), valid.end(), r.name)) continue;
        const char* what = is_sampler ? "sampler" : is_arm ? "arm" : "shape";
        context.report(r.path,
            fmt::format("{}: no {} '{}': expected one of {}{}", r.path, what, r.name.substr(0, 64),
                valid.empty() ? "(none)" : listed(valid, ", "), hint(r.name, valid)));
    }
    check_furnaces(context);
    check_film_files(context);
    check_reached_light(context);
    check_external_arms(context);
    const auto unlike_shapes = [&](const char* what, const std::string& path, const std::string& name) {
        if (const Shape* shape = context.e.find_shape(name))
            context.report(path + name,
                fmt::format("duplicate name '{}': expected a {} with another name than the shape at {}", name, what,
                    to_string(shape->location)));
        for (const MeshObject& mesh : context.e.meshes)
            if (mesh.name == name && path != "meshes.")
                context.report(path + name,
                    fmt::format("duplicate name '{}': expected a {} with another name than the mesh at {}", name, what,
                        to_string(mesh.location)));
    };
    for (const MeshObject& mesh : context.e.meshes) unlike_shapes("mesh", "meshes.", mesh.name);
    for (const DiskLight& disk : context.e.disks) unlike_shapes("disk", "disks.", disk.name);
    for (const Light& light : context.e.lights) {
        unlike_shapes("light", "lights.", light.name);
        for (const DiskLight& disk : context.e.disks)
            if (disk.name == light.name)
                context.report("lights." + light.name,
                    fmt::format("duplicate name '{}': expected a light with another name than the disk at {}",
                        light.name, to_string(disk.location)));
    }
}

}  // namespace crescent
