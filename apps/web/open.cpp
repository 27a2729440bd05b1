// Opens an experiment's text with its settings, and returns what the page needs of it: arms, regions, knobs.
#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "parts.h"
#include "user_sampler.h"

namespace crescent::web {

namespace {

std::unique_ptr<Bench> open_bench;

/// A value that the page may change: its path for --set, and the range of its slider.
ordered_json knob(
    const std::string& path, const std::string& label, const std::string& unit, double low, double high, bool log) {
    return {{"path", path}, {"label", label}, {"unit", unit}, {"low", low}, {"high", high}, {"log", log}};
}

void add_material_knobs(const std::string& name, const Material& m, ordered_json& to) {
    const auto add = [&](ordered_json k, ordered_json value) {
        k["value"] = std::move(value);
        to.push_back(std::move(k));
    };
    const LobeInfo& lobe = lobe_info(m.brdf);
    if (m.s && !m.inherits_s) add(knob(name + ".s", "s of " + name, "", 1, 4096, true), *m.s);
    if (m.rho_s > 0 && lobe.parameter == LobeParameter::alpha)
        add(knob(name + ".alpha", "alpha of " + name, "", 0.01, 1, true), m.alpha.value_or(0.3));
    add(knob(name + ".rho_d", "rho_d of " + name, "", 0, 1, false), m.rho_d);
    if (m.rho_s > 0 && !m.specular) add(knob(name + ".rho_s", "rho_s of " + name, "", 0, 1, false), m.rho_s);
}

/// A light's lengths and its centre or edges; its direction can be changed only in the page's address.
void add_light_knobs(const Light& light, ordered_json& to) {
    ordered_json places = ordered_json::array();  // after the lengths
    std::visit(
        [&]<class Kind>(const Kind& kind) {
            for (const Parameter<Kind>& parameter : Kind::parameters()) {
                const std::string key(parameter.name), path = light.name + "." + key;
                const std::string label = (key == "center" ? "place" : key) + " of " + light.name;
                if (const auto* length = std::get_if<double Kind::*>(&parameter.member)) {
                    to.push_back(knob(path, label, "m", 0.01, 1, true));
                    to.back()["value"] = kind.**length;
                } else if (const auto* v = std::get_if<Vec3d Kind::*>(&parameter.member); v && !parameter.unit_vector) {
                    places.push_back(knob(path, label, "m", -4, 4, false));
                    places.back()["value"] = {(kind.**v).x, (kind.**v).y, (kind.**v).z};
                }
            }
        },
        light.form);
    for (ordered_json& place : places) to.push_back(std::move(place));
}

ordered_json knobs(const Experiment& e) {
    ordered_json entries = ordered_json::array();
    const std::optional<std::size_t> main = e.surface_of_s();
    if (main) add_material_knobs(e.surface_name(*main), e.material(*main), entries);
    for (std::size_t k = 0; k < e.surface_count(); ++k)
        if (main != k && (e.material(k).rho_s > 0 || k >= e.shapes.size()))
            add_material_knobs(e.surface_name(k), e.material(k), entries);
    const auto add = [&](ordered_json k, ordered_json value) {
        k["value"] = std::move(value);
        entries.push_back(std::move(k));
    };
    for (const LightTable& table : all_lights(e)) add_light_knobs(table.light, entries);
    if (e.sky) {
        add(knob("sky.rotation", "rotation of the sky", "°", -180, 180, false), e.sky->rotation);
        add(knob("sky.scale", "scale of the sky", "", 0.01, 100, true), e.sky->scale);
    } else add(knob("fill.radiance", "fill", "W/(sr m²)", 0, 4, false), e.fill);
    add(knob("firefly_k", "firefly k", "", 0.1, 100, true), e.firefly_k);
    add(knob("seed", "seed", "", 0, 4294967295.0, false), e.seed);
    return entries;
}

ordered_json arms(const Bench& b) {
    const Experiment& e = b.experiment;
    ordered_json entries = ordered_json::array();
    for (const ArmPlan& arm : e.arms) {
        const SamplerInfo* info = find_arm_info(arm.sampler);
        if (!info) {
            const SampleCost cost = cost_of_sample(sampler_of(arm));
            entries.push_back({{"name", arm.name}, {"sampler", ""}, {"n", arm.n}, {"techniques", cost.directions},
                {"summary",
                    arm.is_combination() ? fmt::format("a combination of {}", fmt::join(arm.combination.of, ", "))
                                         : "the density of the code above"},
                {"formula", ""}, {"misses", ""}});
            continue;
        }
        entries.push_back({{"name", arm.name}, {"sampler", arm.sampler}, {"n", arm.n}, {"techniques", info->techniques},
            {"summary", formula::html(info->summary)}, {"formula", formula::mathml(info->formula)},
            {"misses", missed_light(arm, e)}});
    }
    return entries;
}

ordered_json described(const Bench& b) {
    const Experiment& e = b.experiment;
    ordered_json out = {{"title", e.title}, {"width", e.image.width}, {"height", e.image.height}, {"seed", e.seed},
        {"s", e.s()}, {"n", e.n}, {"firefly_k", e.firefly_k}, {"hash", fmt::format("{:016x}", hash(e))}};
    out["arms"] = arms(b);
    out["regions"] = ordered_json::array();
    for (const Region& r : e.regions)
        out["regions"].push_back({{"name", r.name}, {"box", {r.box.x0, r.box.y0, r.box.x1, r.box.y1}}});
    out["knobs"] = knobs(e);
    const ReferenceKind kind = e.reference.kind;
    out["reference"] = kind == ReferenceKind::paired ? "paired" : kind == ReferenceKind::note ? "note" : "quadrature";
    out["reference_cost"] = reference_cost(e);
    out["source"] = e.figures ? e.figures->source : "";
    return out;
}

}  // namespace

Bench::Bench(Experiment from) : experiment(std::move(from)), scene(experiment) {
    for (const ArmPlan& arm : experiment.arms)
        if (arm.is_external()) external_samplers[arm.name] = page_sampler();
    add_combinations(experiment, external_samplers);
}

SamplerRef sampler_of(const ArmPlan& arm) { return {arm.sampler, external_of(bench().external_samplers, arm.name)}; }

Bench& bench() {
    ensure(open_bench != nullptr, "an experiment was opened");
    return *open_bench;
}

Slot& slot(int index) {
    ensure(index >= 0 && static_cast<std::size_t>(index) < bench().slots.size(), "a film that was begun");
    return bench().slots[static_cast<std::size_t>(index)];
}

const ArmPlan& arm_of(const std::string& name) {
    const ArmPlan* arm = bench().experiment.find_arm(name);
    if (!arm) throw InputError({bench().experiment.file, 0, 0}, "no arm '" + name + "' in this experiment");
    return *arm;
}

/// {file, text, set: ["path=value"], published: text or ""} -> what the page shows of it.
CRESCENT_EXPORT(open)()->void {
    const ordered_json query = request();
    Experiment e = parse(query.at("text").get<std::string>(), query.at("file").get<std::string>(),
        query.at("set").get<std::vector<std::string>>());
    for (const ArmPlan& arm : e.arms)
        if (arm.is_external() && arm.exec != exec_of_page)
            throw InputError(
                arm.location, "the arm '" + arm.name + "' is a program of its own, which a page cannot start");
    if (e.sky) load_sky(*e.sky);
    read_meshes(e);
    const std::string published = query.at("published").get<std::string>();
    if (e.published && !published.empty()) e.figures = parse_published(published, *e.published);
    std::vector<Slot> films;  // allocated memory is reused; two images of the largest size would not fit
    if (open_bench && e.image.width == open_bench->experiment.image.width &&
        e.image.height == open_bench->experiment.image.height)
        films = std::move(open_bench->slots);
    open_bench.reset();
    open_bench = std::make_unique<Bench>(std::move(e));
    open_bench->slots = std::move(films);
    respond(described(*open_bench));
}

/// The samplers that an arm may have, with one line about each.
CRESCENT_EXPORT(samplers)()->void {
    ordered_json entries = ordered_json::array();
    for (const SamplerInfo& info : sampler_infos())
        entries.push_back({{"name", info.name}, {"label", info.label}, {"summary", formula::html(info.summary)},
            {"needs_s", info.needs_s}});
    respond(entries);
}

}  // namespace crescent::web
