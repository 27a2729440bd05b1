// Values derived from an experiment.
#include "experiment/experiment.h"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>

#include "experiment/input_files.h"
#include "samplers/info.h"

namespace crescent {

namespace {

template <class T> const T* find_named(const std::vector<T>& items, std::string_view name) {
    const auto it = std::find_if(items.begin(), items.end(), [&](const T& item) { return item.name == name; });
    return it == items.end() ? nullptr : &*it;
}

}  // namespace

Experiment Experiment::with_s(double other) const {
    Experiment e = *this;
    if (const auto surface = surface_of_s()) e.material(*surface).s = other;
    for (std::size_t k = 0; k < e.surface_count(); ++k)
        if (e.material(k).inherits_s) e.material(k).s = other;
    return e;
}

std::uint64_t Experiment::n_of(const ArmPlan& arm) const {
    if (std::find(arm.n.begin(), arm.n.end(), n) != arm.n.end()) return n;
    return arm.n.empty() ? n : arm.n.back();
}

std::string Experiment::surface_path(std::size_t surface) const {
    return (surface < shapes.size() ? "shapes." : "meshes.") + surface_name(surface);
}

const ArmPlan* Experiment::find_arm(std::string_view name) const { return find_named(arms, name); }
const Region* Experiment::find_region(std::string_view name) const { return find_named(regions, name); }

SourceLocation Experiment::place_of(const std::string& path) const {
    for (std::string prefix = path;; prefix.resize(prefix.rfind('.'))) {
        if (const auto it = places.find(prefix); it != places.end()) return it->second;
        if (prefix.find('.') == std::string::npos) return {file, 0, 0};
    }
}

// ---- The file names of films.

std::string film_file(std::string_view arm, double s, double own_s) {
    return s == own_s ? std::string(arm) : fmt::format("{}-s{}", arm, s);
}

// ---- Compares the largest channel of rho_d plus rho_s of each surface with 1 (reflectances have no unit), and finds
// requested article checks that cannot be measured.

namespace {

/// Returns the largest channel of rho_d, with that of its texture.
double brightest_rho_d(const Experiment& experiment, std::size_t surface) {
    const Rgb& rho_d = experiment.material(surface).rho_d;
    if (surface < experiment.shapes.size()) return std::ranges::max(rho_d);
    const auto& image = experiment.meshes[surface - experiment.shapes.size()].rho_d_texture.image;
    if (!image) return std::ranges::max(rho_d);
    double brightest = 0;
    for (std::size_t k = 0; k < image->size(); ++k)
        brightest = std::max(brightest, rho_d[k % 3] * static_cast<double>((*image)[k]));
    return brightest;
}

}  // namespace

std::vector<std::string> warnings_of(const Experiment& experiment) {
    std::vector<std::string> out;
    for (std::size_t k = 0; k < experiment.surface_count(); ++k) {
        const double albedo = brightest_rho_d(experiment, k) + experiment.material(k).rho_s;
        constexpr double rounding = 1e-6;  // of decimal numbers with seven digits, and of texels in single precision
        if (albedo > 1 + rounding)
            out.push_back(fmt::format("{}: rho_d + rho_s is {:.7g}, above 1: it reflects more than it receives",
                experiment.surface_name(k), albedo));
    }
    if (experiment.sky)
        if (std::string note = note_on_sky(*experiment.sky); !note.empty()) out.push_back(std::move(note));
    if (const std::string reason = why_no_evidence(experiment); experiment.note_evidence && !reason.empty())
        out.push_back("note_evidence measures nothing: " + reason);
    return out;
}

// ---- The article explains the Phong sampler on a Phong lobe: both must exist, the lobe on the exponent control's
// shape if there is a control.

const Shape* evidence_shape(const Experiment& experiment) {
    const auto is_phong = [](const Shape& shape) {
        return shape.material.rho_s > 0 && shape.material.brdf == lobe_named("phong");
    };
    if (experiment.exponent) {
        const Shape* shape = experiment.find_shape(experiment.exponent->shape);
        return shape && is_phong(*shape) ? shape : nullptr;
    }
    const auto match = std::ranges::find_if(experiment.shapes, is_phong);
    return match == experiment.shapes.end() ? nullptr : &*match;
}

std::string why_no_evidence(const Experiment& experiment) {
    if (std::ranges::find(experiment.arms, "phong", &ArmPlan::sampler) == experiment.arms.end())
        return "no arm has the sampler 'phong'";
    if (evidence_shape(experiment)) return {};
    return experiment.exponent ? "exponent.shape has no Phong lobe" : "no shape has a Phong lobe";
}

// ---- Looks up SamplerInfo by the arm's sampler; a sampler that is not in the list draws one direction, reaches all
// light and depends on s.

int techniques_of(const ArmPlan& arm) {
    const SamplerInfo* info = find_arm_info(arm.sampler);
    return info ? info->techniques : 1;
}

namespace {

std::string source_of(const CombinationPlan& plan) {
    const std::string last = plan.of.empty() ? "" : plan.of.back();
    const std::vector<std::string> others(plan.of.begin(), plan.of.end() - (plan.of.empty() ? 0 : 1));
    const std::string parts = others.empty() ? last : fmt::format("{} and {}", fmt::join(others, ", "), last);
    switch (*plan.kind) {
        case CombinationKind::mixture: return "the mixture of " + parts;
        case CombinationKind::ris:
            return fmt::format("one of {} candidates of {}, resampled in proportion to {}", plan.candidates.value_or(1),
                parts, plan.target.value_or(target_product));
        case CombinationKind::mis: break;
    }
    const bool is_power = plan.heuristic == MisHeuristic::power;
    const char* heuristic = !plan.weights.empty() ? "a weighted sum"
        : is_power                                ? "the power heuristic"
                                                  : "the balance heuristic";
    return fmt::format("{} of {}{}", heuristic, parts, plan.draw == MisDraw::one ? ", one of them a sample" : "");
}

}  // namespace

std::string source_of(const ArmPlan& arm) {
    if (arm.is_combination()) return source_of(arm.combination);
    if (arm.plugin) return "the plugin " + *arm.plugin;
    if (arm.exec) return "the program " + *arm.exec;
    return arm.python ? "the Python sampler " + *arm.python : "";
}

std::string missed_light(const ArmPlan& arm, const Experiment& experiment) {
    const SamplerInfo* info = find_arm_info(arm.sampler);
    if (!info) return "";
    const auto shines = [](const auto& light) { return light.radiance[0] + light.radiance[1] + light.radiance[2] > 0; };
    const bool has_lights =
        std::ranges::any_of(experiment.disks, shines) || std::ranges::any_of(experiment.lights, shines);
    const Rgb& fill = experiment.fill;
    std::string out;
    for (const auto& [is_present, is_reached, name] :
        {std::tuple(fill[0] + fill[1] + fill[2] > 0, info->reaches.fill, "the fill"),
            {has_lights, info->reaches.lights, "the lights"},
            {experiment.sky.has_value(), info->reaches.sky, "the sky"},
            {std::ranges::any_of(experiment.meshes, &MeshObject::emits), info->reaches.triangles, "the triangles"}})
        if (is_present && !is_reached) out += (out.empty() ? "" : " and ") + std::string(name);
    return out;
}

bool tells_s(const std::string& arm, double s, const Experiment& experiment) {
    if (s != experiment.s()) return true;
    if (s == 0) return false;  // no surface has an exponent
    const ArmPlan* plan = experiment.find_arm(arm);
    const SamplerInfo* info = plan ? find_arm_info(plan->sampler) : nullptr;
    return !info || info->needs_s;
}

bool any_tells_s(const Experiment& experiment) {
    return std::ranges::any_of(
        experiment.arms, [&](const ArmPlan& arm) { return tells_s(arm.name, experiment.s(), experiment); });
}

std::vector<LightTable> all_lights(const SceneData& scene) {
    std::vector<LightTable> out;
    for (const DiskLight& disk : scene.disks) out.push_back({"disks." + disk.name, disk.light()});
    for (const Light& light : scene.lights) out.push_back({"lights." + light.name, light});
    return out;
}

}  // namespace crescent
