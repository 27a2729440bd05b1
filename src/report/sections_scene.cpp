// The model of theory.html, as the experiment gives it, and of the reference. Lengths in scene units, radiance in
// W/(sr m^2).
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "experiment/experiment.h"
#include "output/formula.h"
#include "report/page.h"
#include "samplers/info.h"
#include "scene/lobes/lobe.h"

namespace crescent {
namespace {

std::string vec(const Vec3d& v) {
    return with_minus(fmt::format("({}, {}, {})", compact(v.x), compact(v.y), compact(v.z)));
}
std::string rgb(const Rgb& c) {
    if (c[0] == c[1] && c[1] == c[2]) return shortest(c[0]);
    return html::value(fmt::format("({}, {}, {})", compact(c[0]), compact(c[1]), compact(c[2])));
}

std::string value_of(double x) { return shortest(x); }
std::string value_of(bool x) { return x ? "yes" : "no"; }
std::string value_of(const Vec3d& v) { return html::value(vec(v)); }
std::string value_of(const std::optional<Rgb>& c) { return c ? rgb(*c) : ""; }

/// Returns "centre (0, 1, 0), radius 0.5", the parameters of the kind that `variant` holds, without those that are not
/// given.
template <class Any> std::string parameters_of(const Any& variant) {
    return std::visit(
        []<class Kind>(const Kind& kind) {
            std::string out;
            for (const Parameter<Kind>& parameter : Kind::parameters()) {
                const std::string value =
                    std::visit([&](auto member) { return value_of(kind.*member); }, parameter.member);
                if (value.empty()) continue;
                std::string name(parameter.name);
                std::replace(name.begin(), name.end(), '_', ' ');
                out += fmt::format("{}{} {}", out.empty() ? "" : ", ", name, value);
            }
            return out;
        },
        variant);
}

std::string lobe(const Material& m) {
    if (m.rho_s == 0) return "–";
    const std::string share = "<i>ρ</i><sub>s</sub> = " + (m.specular ? rgb(*m.specular) : shortest(m.rho_s));
    const LobeInfo& lobe = lobe_info(m.brdf);
    const bool has_alpha = lobe.parameter == LobeParameter::alpha;
    return fmt::format("{}, {}, {} = {}", share, lobe.label, has_alpha ? "<i>α</i>" : "<i>s</i>",
        shortest((has_alpha ? m.alpha : m.s).value_or(0)));
}

Json shape_of(const Page& page, const std::string& name, std::string_view kind, const std::string& description,
    const Material& material, bool blocks) {
    const auto entry = page.in.metrics.shape_pixels.find(name);
    const bool is_known = entry != page.in.metrics.shape_pixels.end();
    return {{"name", name}, {"kind", kind}, {"where", description}, {"rho_d", rgb(material.rho_d)}, {"rho_d_file", ""},
        {"lobe", lobe(material)}, {"alpha_file", ""}, {"blocks", blocks},
        {"pixels", is_known ? std::to_string(entry->second) : "–"}};
}

Json shapes_of(const Page& page) {
    Json out = Json::array();
    for (const Shape& shape : page.in.experiment.shapes)
        out.push_back(
            shape_of(page, shape.name, shape.kind(), parameters_of(shape.form), shape.material, shape.occludes));
    for (const MeshObject& mesh : page.in.experiment.meshes) {
        std::string description = escape(mesh.file);
        if (mesh.pack) description += fmt::format(", {} triangles", mesh.pack->mesh.triangles.size());
        if (!mesh.instances.empty()) description += fmt::format(", {} instances", mesh.instances.size());
        if (mesh.emits()) description += fmt::format(", emits {} W/(sr m²)", rgb(mesh.emission));
        Json row = shape_of(page, mesh.name, "mesh", description, mesh.material, true);
        row["rho_d_file"] = mesh.rho_d_texture.file.value_or("");
        row["alpha_file"] = mesh.alpha_texture.file.value_or("");
        out.push_back(row);
    }
    return out;
}

}  // namespace

Json scene_section(Page& page) {
    const Experiment& e = page.in.experiment;
    Json lights = Json::array(), sky = false;
    for (const auto& [path, light] : all_lights(e))
        lights.push_back({{"name", light.name}, {"kind", light.kind()}, {"where", parameters_of(light.form)},
            {"radiance", rgb(light.radiance)}});
    if (e.sky)
        sky = {{"file", e.sky->file}, {"layer", e.sky->layer.value_or("")},
            {"content", e.sky->content.value_or("not read")}, {"rotation", shortest(e.sky->rotation)},
            {"scale", shortest(e.sky->scale)}};
    return {{"eye", vec(e.camera.eye)}, {"target", vec(e.camera.target)}, {"vfov", shortest(e.camera.vfov_deg)},
        {"width", e.image.width}, {"height", e.image.height}, {"geometry_pixels", page.in.metrics.geometry_pixels},
        {"warnings", page.find.warnings()}, {"plates", page.figures.plates(PlateKind::gallery)},
        {"shapes", shapes_of(page)}, {"lights", lights}, {"sky", sky}, {"fill", rgb(e.fill)}};
}

// ---- The densities of the arms with the maps that draw from them, as stated in the samplers' own files.

namespace {

std::string sample_counts(const ArmPlan& arm) {
    std::vector<std::string> counts;
    for (const std::uint64_t n : arm.n) counts.push_back(std::to_string(n));
    return listed(counts);
}

/// Returns whether the density depends only on the polar angle about one direction.
bool is_about_an_axis(const ArmPlan& arm) {
    const SamplerInfo* info = find_arm_info(arm.sampler);
    return info && info->about != PdfAxis::none;
}

Json density_of(const ArmPlan& arm, const Experiment& e) {
    const SamplerInfo* info = find_arm_info(arm.sampler);
    Json out = {{"name", arm.name}, {"sampler", ""}, {"missed", ""}, {"source", ""}, {"density", ""}, {"draw", ""},
        {"axis", ""}, {"sample_counts", sample_counts(arm)}};
    if (!info) {
        out["source"] = source_of(arm);
        return out;
    }
    if (arm.name == arm.sampler) out["name"] = info->label;
    else out["sampler"] = arm.sampler;
    out["missed"] = missed_light(arm, e);
    out["density"] = formula::mathml(info->density);
    out["draw"] = formula::html(info->draw);
    out["axis"] = formula::html(info->axis);
    return out;
}

}  // namespace

Json densities(Page& page) {
    const auto& arms = page.in.experiment.arms;
    if (arms.empty()) return false;
    Json rows = Json::array();
    for (const ArmPlan& arm : arms) rows.push_back(density_of(arm, page.in.experiment));
    return {{"three", arms.size() == 3}, {"about_axes", std::ranges::all_of(arms, is_about_an_axis)}, {"rows", rows},
        {"plates", page.figures.plates(PlateKind::rose)}};
}

// ---- The question, and the estimator with its metrics.

namespace {

std::string spelled(std::size_t count) {
    static const char* words[] = {"no arms", "one arm", "two arms", "three arms", "four arms", "five arms", "six arms"};
    return count < 7 ? words[count] : fmt::format("{} arms", count);
}

/// Returns the lobes of the scene's glossy surfaces, in the list's order.
std::vector<const LobeInfo*> lobes_of(const Experiment& e) {
    std::vector<const LobeInfo*> out;
    for (const LobeInfo& lobe : lobe_infos()) {
        bool is_used = false;
        for (std::size_t k = 0; k < e.surface_count(); ++k)
            is_used = is_used || (e.material(k).rho_s > 0 && e.material(k).brdf == lobe.kind);
        if (is_used) out.push_back(&lobe);
    }
    return out;
}

}  // namespace

namespace {

/// Returns "170 × 50 pixels", or "8,123 pixels of body".
std::string pixels_of(const Page& page, const Region& region) {
    if (region.object().empty()) return fmt::format("{} × {} pixels", region.box.width(), region.box.height());
    const auto& runs = page.in.metrics.runs;
    const RegionMetrics* region_metrics = runs.empty() ? nullptr : runs.front().region(region.name);
    const std::string object_words = "pixels of " + escape(region.object());
    return region_metrics ? fmt::format("{} {}", region_metrics->pixels, object_words) : object_words;
}

}  // namespace

Json question(const Page& page) {
    const Experiment& e = page.in.experiment;
    std::vector<Json> names, regions;
    for (const ArmPlan& arm : e.arms) names.push_back({{"name", arm.name}});
    for (const Region& r : e.regions) regions.push_back({{"name", r.name}, {"pixels", pixels_of(page, r)}});
    return {{"count_of_arms", spelled(names.size())}, {"names", separated(names)}, {"rays", after_space(ray_words(e))},
        {"bias", after_space(bias_words(e))}, {"one_region", regions.size() == 1}, {"regions", separated(regions)}};
}

Json estimator_equation(const Page& page) {
    Json lobes = Json::array(), mirror_lobe = false;
    bool is_about_mirror = false;
    for (const LobeInfo* lobe : lobes_of(page.in.experiment)) {
        lobes.push_back({{"label", lobe->label}, {"formula", formula::mathml(lobe->formula)},
            {"summary", formula::html(lobe->summary)}});
        is_about_mirror = is_about_mirror || lobe->about_mirror;
    }
    if (const double s = page.find.s(); is_about_mirror && s > 0)
        mirror_lobe = {{"slip", percent(1 / (s + 1), 2)}, {"s", shortest(s)}};
    return {{"lobes", lobes}, {"mirror_lobe", mirror_lobe}, {"firefly_k", shortest(page.in.experiment.firefly_k)}};
}

// ---- The reference, and the effect of using the Monte Carlo reference of the article instead.

namespace {

/// Returns the runs whose squared error is below 0, with its interval.
Json below_the_reference(const ReportInputs& in) {
    Json out = Json::array();
    for (const RunMetrics& run : in.metrics.runs)
        for (const RegionMetrics& region : run.regions)
            if (region.is_paired() && region.mse < 0)
                out.push_back(
                    {{"run", run_html(run.key, in.experiment)}, {"region", region.region}, {"run_seed", run.key.seed},
                        {"mse", with_minus(figures(region.mse, 2))}, {"low", with_minus(figures(region.mse_low(), 2))},
                        {"high", with_minus(figures(region.mse_high(), 2))}});
    return out;
}

Json row_of(const ReferenceQuality& r) { return {{"region", r.region}, {"s", shortest(r.s)}}; }

/// Returns where the reference's own error is too large a part of an RMSE.
Json too_coarse(const std::vector<ReferenceQuality>& references) {
    Json out = Json::array();
    for (const ReferenceQuality& r : references)
        if (r.error_share > most_error_share) {
            out.push_back(row_of(r));
            out.back()["share"] = percent(r.error_share, 2);
        }
    return out;
}

/// The Monte Carlo reference against the quadrature.
void add_both(const std::vector<ReferenceQuality>& references, Json& to) {
    for (const ReferenceQuality& r : references) {
        Json row = row_of(r);
        row["difference"] = cell_text(figures(*r.rms_difference, 3));
        row["standard_error"] = cell_text(figures(*r.rms_standard_error, 3));
        row["error"] = cell_text(figures(*r.quadrature_error, 2));
        row["change"] = cell_text(percent(*r.max_relative_rmse_change, 2));
        to["both"].push_back(row);
    }
    const auto worst =
        std::ranges::max_element(references, {}, [](const ReferenceQuality& r) { return *r.max_relative_rmse_change; });
    to["worst"] = row_of(*worst);
    to["worst"]["change"] = percent(*worst->max_relative_rmse_change, 2);
    to["worst"]["explained"] = std::ranges::all_of(
        references, [](const ReferenceQuality& r) { return *r.rms_difference <= 2 * *r.rms_standard_error; });
}

void add_one(const std::vector<ReferenceQuality>& references, Json& to) {
    for (const ReferenceQuality& r : references) {
        Json row = row_of(r);
        row["error"] = cell_text(figures(r.paired_error ? *r.paired_error : *r.quadrature_error, 2));
        row["share"] = std::isfinite(r.error_share) ? percent(r.error_share, 2) : "above it";
        to["one"].push_back(row);
    }
}

}  // namespace

Json reference(Page& page) {
    const auto& references = page.in.metrics.references;
    const ReferencePlan& plan = page.in.experiment.reference;
    Json plates = page.figures.plates(PlateKind::reference);
    if (references.empty() && plates.empty()) return false;
    const bool has_both = !references.empty() && references.front().max_relative_rmse_change.has_value();
    const bool paired = plan.kind == ReferenceKind::paired;
    Json out = {{"quadrature", !has_both && !paired}, {"paired", !has_both && paired}, {"two", has_both}, {"n", plan.n},
        {"own_seed", plan.seed}, {"lobe", plural(plan.lobe_spp, "sample")}, {"disk", plural(plan.disk_spp, "sample")},
        {"used", plan.kind == ReferenceKind::quadrature ? "quadrature" : "Monte Carlo reference"},
        {"both", Json::array()}, {"one", Json::array()}, {"too_coarse", too_coarse(references)},
        {"below", below_the_reference(page.in)}, {"plates", std::move(plates)}};
    if (has_both) add_both(references, out);
    else add_one(references, out);
    return out;
}

}  // namespace crescent
