// Opens an experiment's text with its settings, and returns what the page needs of it: arms, regions, knobs.
#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "user_sampler.h"

namespace crescent::web {

namespace {

std::unique_ptr<Bench> opened;

/// A value that the page may change: its path for --set, and the range of its slider.
ordered_json knob(
    const std::string& path, const std::string& label, const std::string& unit, double low, double high, bool log) {
    return {{"path", path}, {"label", label}, {"unit", unit}, {"low", low}, {"high", high}, {"log", log}};
}

void add_material_knobs(const Shape& shape, ordered_json& to) {
    const Material& m = shape.material;
    const auto add = [&](ordered_json k, ordered_json value) {
        k["value"] = std::move(value);
        to.push_back(std::move(k));
    };
    const LobeInfo& lobe = lobe_info(m.brdf);
    if (m.s && !m.inherits_s) add(knob(shape.name + ".s", "s of " + shape.name, "", 1, 4096, true), *m.s);
    if (m.rho_s > 0 && lobe.parameter == LobeParameter::alpha)
        add(knob(shape.name + ".alpha", "alpha of " + shape.name, "", 0.01, 1, true), m.alpha.value_or(0.3));
    add(knob(shape.name + ".rho_d", "rho_d of " + shape.name, "", 0, 1, false), m.rho_d);
    if (m.rho_s > 0 && !m.specular)
        add(knob(shape.name + ".rho_s", "rho_s of " + shape.name, "", 0, 1, false), m.rho_s);
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
    ordered_json all = ordered_json::array();
    const Shape* main = e.shape_of_s();
    if (main) add_material_knobs(*main, all);
    for (const Shape& shape : e.shapes)
        if (&shape != main && shape.material.rho_s > 0) add_material_knobs(shape, all);
    const auto add = [&](ordered_json k, ordered_json value) {
        k["value"] = std::move(value);
        all.push_back(std::move(k));
    };
    for (const LightTable& table : all_lights(e)) add_light_knobs(table.light, all);
    add(knob("fill.radiance", "fill", "W/(sr m²)", 0, 4, false), e.fill);
    add(knob("firefly_k", "firefly k", "", 0.1, 100, true), e.firefly_k);
    add(knob("seed", "seed", "", 0, 4294967295.0, false), e.seed);
    return all;
}

ordered_json arms(const Experiment& e) {
    ordered_json all = ordered_json::array();
    for (const ArmPlan& arm : e.arms) {
        const SamplerInfo* info = find_arm_info(arm.sampler);
        if (!info) {
            all.push_back({{"name", arm.name}, {"sampler", ""}, {"n", arm.n}, {"techniques", 1},
                {"summary", "the density of the code above"}, {"formula", ""}, {"misses", ""}});
            continue;
        }
        all.push_back({{"name", arm.name}, {"sampler", arm.sampler}, {"n", arm.n}, {"techniques", info->techniques},
            {"summary", formula::html(info->summary)}, {"formula", formula::mathml(info->formula)},
            {"misses", missed_light(arm, e)}});
    }
    return all;
}

ordered_json described(const Experiment& e) {
    ordered_json out = {{"title", e.title}, {"width", e.image.width}, {"height", e.image.height}, {"seed", e.seed},
        {"s", e.s()}, {"n", e.n}, {"firefly_k", e.firefly_k}, {"hash", fmt::format("{:016x}", hash(e))}};
    out["arms"] = arms(e);
    out["regions"] = ordered_json::array();
    for (const Region& r : e.regions)
        out["regions"].push_back({{"name", r.name}, {"box", {r.box.x0, r.box.y0, r.box.x1, r.box.y1}}});
    out["knobs"] = knobs(e);
    out["quadrature"] = e.reference.kind == ReferenceKind::quadrature;
    out["source"] = e.figures ? e.figures->source : "";
    return out;
}

}  // namespace

Bench& bench() {
    ensure(opened != nullptr, "an experiment was opened");
    return *opened;
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
    if (e.sky) throw InputError(e.sky->at, "a page cannot read the image of a sky");
    for (const ArmPlan& arm : e.arms)
        if (!find_arm_info(arm.sampler) && arm.exec != exec_of_page)
            throw InputError(arm.at, "the arm '" + arm.name + "' is a program of its own, which a page cannot start");
    const std::string published = query.at("published").get<std::string>();
    if (e.published && !published.empty()) e.figures = parse_published(published, *e.published);
    std::vector<Slot> films;  // allocated memory is reused; two images of the largest size would not fit
    if (opened && e.image.width == opened->experiment.image.width && e.image.height == opened->experiment.image.height)
        films = std::move(opened->slots);
    opened.reset();
    opened = std::make_unique<Bench>(std::move(e));
    opened->slots = std::move(films);
    respond(described(opened->experiment));
}

/// The samplers that an arm may have, with one line about each.
CRESCENT_EXPORT(samplers)()->void {
    ordered_json all = ordered_json::array();
    for (const SamplerInfo& info : sampler_infos())
        all.push_back({{"name", info.name}, {"label", info.label}, {"summary", formula::html(info.summary)},
            {"needs_s", info.needs_s}});
    respond(all);
}

}  // namespace crescent::web
