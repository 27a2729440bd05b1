// The model of what follows from a run: further experiments (one command each), the limits of this run, its assertions
// and its provenance.
#include <algorithm>
#include <fmt/format.h>

#include "base/text.h"
#include "experiment/queries.h"
#include "report/wording.h"
#include "samplers/info.h"
#include "scene/lobes/lobe.h"

namespace crescent::inline report {
namespace {

/// Returns a command line that runs the same experiment with some keys changed.
std::string with(const Page& page, const std::vector<std::string>& settings) {
    std::string out = "crescent run " + shell_word(page.in.provenance.experiment_file);
    for (const std::string& setting : settings) out += " --set " + shell_word(setting);
    return out;
}

/// Returns the shape of the exponent control, else the first with a lobe.
const Shape* glossy(const Experiment& e) {
    for (const Shape& shape : e.shapes)
        if (e.exponent && shape.name == e.exponent->shape && shape.material.rho_s > 0) return &shape;
    for (const Shape& shape : e.shapes)
        if (shape.material.rho_s > 0) return &shape;
    return nullptr;
}

std::string box_text(const Box& b) { return fmt::format("[{}, {}, {}, {}]", b.x0, b.y0, b.x1, b.y1); }

Box shifted(const Experiment& e, Box b) {
    const int by = std::max(1, b.width() / 2);
    const int shift = b.x1 + by < e.image.width ? by : -std::min(by, b.x0);
    return {b.x0 + shift, b.y0, b.x1 + shift, b.y1};
}

std::string ladder_text(const ArmPlan& arm) {
    std::string out;
    for (const std::uint64_t n : arm.n) out += std::to_string(n) + ", ";
    return "[" + out + std::to_string(arm.n.back() * 4) + "]";
}

struct Row {
    std::string question, command, expect;
};

void light_rows(const Page& page, std::vector<Row>& rows) {
    const Experiment& e = page.in.experiment;
    const std::vector<LightTable> lights = all_lights(e);
    if (lights.empty()) return;
    if (const auto larger = widened(lights.front(), 4), smaller = widened(lights.front(), 0.25); !larger.empty()) {
        rows.push_back(
            {"A larger light?", with(page, larger), "Broad densities meet it more often; the fireflies thin out."});
        rows.push_back({"A smaller one?", with(page, smaller),
            "Every arm that does not aim at lights misses it; in the limit none can find it."});
    }
    std::vector<std::string> furnace{"fill.radiance=[1, 1, 1]"};
    for (const LightTable& table : lights) furnace.push_back(table.path + ".radiance=[1, 1, 1]");
    rows.push_back({"The whole scene as a white furnace?", with(page, furnace),
        "Each surface shows its albedo; what departs is the arm’s."});
}

/// Returns the --set value that multiplies the number that shapes a lobe, its exponent or its roughness; "" if the
/// shape has no such number, or if the product is not valid in a file.
std::string lobe_setting(const Shape& shape, double of_s, double of_alpha) {
    const bool by_alpha = lobe_info(shape.material.brdf).parameter == LobeParameter::alpha;
    const std::optional<double> now = by_alpha ? shape.material.alpha : shape.material.s;
    if (!now) return {};
    const double then = *now * (by_alpha ? of_alpha : of_s);
    if (then > (by_alpha ? 1 : 1e6)) return {};
    return fmt::format("shapes.{}.{}={}", shape.name, by_alpha ? "alpha" : "s", shortest(then));
}

void material_rows(const Page& page, std::vector<Row>& rows) {
    const Shape* shape = glossy(page.in.experiment);
    if (!shape) return;
    rows.push_back({"A metal instead?", with(page, {fmt::format("shapes.{}.rho_d=[0, 0, 0]", shape->name)}),
        "It has no diffuse part, so Failure B does not show on it."});
    if (const auto wide = lobe_setting(*shape, 0.25, 2); !wide.empty())
        rows.push_back({"More samples under the horizon?", with(page, {wide}),
            "A wider lobe reaches below the surface more often; those samples have weight 0 and count."});
    if (const auto sharp = lobe_setting(*shape, 2, 0.5); !sharp.empty())
        rows.push_back({"A sharper lobe?", with(page, {sharp}), "Better where the lobe is, worse everywhere else."});
}

void sampling_rows(const Page& page, std::vector<Row>& rows) {
    const Experiment& e = page.in.experiment;
    rows.push_back({"Another seed?", with(page, {fmt::format("seed={}", e.seed + 1)}),
        "Rankings that change with the seed are within the noise."});
    rows.push_back(
        {"A stricter or laxer firefly?", with(page, {fmt::format("firefly_k={}", shortest(2 * e.firefly_k))}),
            "Counts fall as k rises; the order of the arms should not."});
    if (!e.arms.empty() && !e.arms.back().n.empty())
        rows.push_back(
            {"More samples?", with(page, {fmt::format("arms.{}.n={}", e.arms.back().name, ladder_text(e.arms.back()))}),
                "One more sample count; the lower ones keep their bits."});
    if (!e.regions.empty())
        rows.push_back({"Another region?",
            with(page,
                {fmt::format(
                    "regions.{}.box={}", e.regions.front().name, box_text(shifted(e, e.regions.front().box)))}),
            "Films do not change; only their evaluation does."});
}

/// Returns whether an arm aims only at the lights or combines several densities.
bool remedies(const Experiment& e) {
    return std::any_of(e.arms.begin(), e.arms.end(), [](const ArmPlan& arm) {
        const SamplerInfo* info = find_arm_info(arm.sampler);
        return info && (info->combines || !info->misses.empty());
    });
}

}  // namespace

Json more_plates(Page& page) {
    Json rest = page.figures.rest();
    return rest.empty() ? Json(false) : Json{{"plates", std::move(rest)}};
}

Json what_ifs(const Page& page) {
    std::vector<Row> rows;
    sampling_rows(page, rows);
    material_rows(page, rows);
    light_rows(page, rows);
    Json out = Json::array();
    for (const Row& row : rows)
        out.push_back({{"question", row.question}, {"line", row.command}, {"expect", row.expect}});
    return {{"rows", out}};
}

Json limits(const Page& page) {
    const Experiment& e = page.in.experiment;
    const auto& bands = page.in.metrics.bands;
    const auto heavy = std::ranges::count_if(bands, [](const SeedSpread& b) { return b.band.heavy; });
    const double chance = chance_of_parted_bands(e.seeds);
    const std::string bias = bias_words(e);
    Json out = {{"bands", false}, {"rays", ray_words(e)}, {"bias", bias.empty() ? "" : bias.substr(1)},
        {"remedies", remedies(e)}, {"one_seed", e.seeds < 2}, {"few_seeds", e.seeds >= 2 && e.seeds < 20},
        {"heavy", heavy > 0 ? std::to_string(heavy) : ""}, {"metrics", bands.size()}};
    if (e.seeds > 1) out["bands"] = {{"chance", chance > 1e-3 ? percent(chance, 2) : "less than 0.1 %"}};
    return out;
}

Json assertions(const Page& page) {
    const auto& all = page.in.metrics.assertions;
    if (all.empty()) return false;
    const auto failed = std::ranges::count_if(all, [](const AssertionResult& a) { return a.failed(); });
    const auto empty = std::ranges::count_if(all, [](const AssertionResult& a) { return a.cannot_fail; });
    Json rows = Json::array();
    for (const AssertionResult& a : all) {
        const bool ran = a.skipped.empty(), holds = ran && !a.failed();
        rows.push_back({{"name", a.name}, {"claim", a.text}, {"measured", cell_text(compact(a.measured))}, {"op", a.op},
            {"bound", cell_text(compact(a.bound))}, {"skipped", a.skipped}, {"fails", ran && a.failed()},
            {"holds", holds}, {"cannot_fail", holds && a.cannot_fail}});
    }
    return {{"total", all.size()}, {"failed", failed > 0 ? std::to_string(failed) : ""},
        {"empty", empty > 0 ? std::to_string(empty) : ""}, {"rows", rows}};
}

Json provenance(const Page& page) {
    const Provenance& p = page.in.provenance;
    Json details = Json::array(), films = Json::array(), part = false;
    for (const auto& [what, message] : p.backend_details) details.push_back({{"what", what}, {"message", message}});
    for (const auto& [name, hash] : page.in.metrics.film_hashes) films.push_back({{"name", name}, {"hash", hash}});
    if (!p.missing().empty()) part = {{"places", ranges_text(p.places)}, {"series", p.series}};
    return {{"commit", p.commit}, {"compiler", p.compiler}, {"backend", p.backend}, {"backend_details", details},
        {"all_seeds", fmt::format("{}", fmt::join(p.seeds, ", "))}, {"part", part}, {"films", films}};
}

}  // namespace crescent::inline report
