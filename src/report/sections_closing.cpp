// The model of the end of the report: the limits of this run, its assertions and its provenance.
#include <algorithm>
#include <fmt/format.h>

#include "experiment/queries.h"
#include "report/wording.h"
#include "samplers/info.h"

namespace crescent::inline report {
namespace {

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
