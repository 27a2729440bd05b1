// Arms are found by their sampler; the surround is the region with the most pixels after the first. N is the
// experiment's if both arms have it, else the middle one of their common sample counts. MIS gets N/2 pairs and N.
#include "cast.h"

#include <fmt/format.h>

#include <algorithm>

namespace crescent::explainer {

namespace {

const ArmPlan* by_sampler(const Experiment& e, const std::string& sampler) {
    const auto arm = std::ranges::find(e.arms, sampler, &ArmPlan::sampler);
    return arm == e.arms.end() ? nullptr : &*arm;
}

/// Returns the arm with this sampler; if there is none, reports an error with the nearest that the experiment has.
std::string needed(const Experiment& e, const std::string& sampler, std::vector<Diagnostic>& diagnostics) {
    if (const ArmPlan* arm = by_sampler(e, sampler)) return arm->name;
    std::vector<std::string> samplers;
    for (const ArmPlan& arm : e.arms) samplers.push_back(arm.sampler);
    const std::string suggestion = nearest(sampler, samplers);
    diagnostics.push_back({e.place_of("arms"),
        fmt::format("the film compares 'cosine' with 'phong', and no arm here samples by '{}'{}; expected [arms.{}]",
            sampler, suggestion.empty() ? "" : " (nearest: '" + suggestion + "')", sampler)});
    return "";
}

/// Returns the arm with this sampler, creating it if needed, with these sample counts added.
std::string added(Experiment& e, const std::string& sampler, const std::vector<std::uint64_t>& sample_counts) {
    for (ArmPlan& arm : e.arms) {
        if (arm.sampler != sampler) continue;
        std::vector<std::uint64_t> counts;
        std::ranges::set_union(arm.n, sample_counts, std::back_inserter(counts));
        arm.n = counts;
        return arm.name;
    }
    std::string name = sampler;
    while (e.find_arm(name)) name += "-too";
    e.arms.push_back({name, sampler, sample_counts, {}});
    return name;
}

std::vector<std::uint64_t> shared(const ArmPlan& a, const ArmPlan& b) {
    std::vector<std::uint64_t> counts;
    std::ranges::set_intersection(a.n, b.n, std::back_inserter(counts));
    return counts;
}

}  // namespace

Cast cast_of(Experiment& e) {
    Cast c;
    std::vector<Diagnostic> diagnostics;
    c.cosine = needed(e, "cosine", diagnostics);
    c.phong = needed(e, "phong", diagnostics);
    if (const ArmPlan* arm = by_sampler(e, "uniform")) c.uniform = arm->name;
    if (!c.cosine.empty() && !c.phong.empty()) {
        c.sample_counts = shared(*e.find_arm(c.cosine), *e.find_arm(c.phong));
        if (c.sample_counts.size() < 2)
            diagnostics.push_back({e.place_of("arms." + c.phong),
                fmt::format("the film follows '{}' and '{}' up one ladder; expected two n or more that both have",
                    c.cosine, c.phong)});
    }
    if (e.regions.size() < 2)
        diagnostics.push_back(
            {e.place_of("regions"), "the film needs two regions: the highlight first, then the surround"});
    if (all_lights(e).empty())
        diagnostics.push_back(
            {e.place_of("disks"), "the film needs a light other than the fill, which a cosine sample rarely meets"});
    const bool has_lobe = std::ranges::any_of(
        e.shapes, [](const Shape& s) { return s.material.rho_s > 0 && s.material.brdf == lobe_named("phong"); });
    if (!has_lobe)
        diagnostics.push_back(
            {e.place_of("shapes"), "the film needs a shape with a Phong lobe: rho_s above 0 and brdf = \"phong\""});
    if (!diagnostics.empty()) throw InputError(std::move(diagnostics));

    c.highlight = e.regions.front().name;
    const auto area = [](const Region& r) { return r.box.width() * r.box.height(); };
    c.surround = std::ranges::max_element(e.regions.begin() + 1, e.regions.end(), {}, area)->name;
    c.s = e.s();
    c.seed = e.seed;
    c.n = std::ranges::find(c.sample_counts, e.n) != c.sample_counts.end()
        ? e.n
        : c.sample_counts[c.sample_counts.size() / 2];
    c.mixture = added(e, "mixture", {c.n});
    c.mis =
        added(e, "mis-balance", c.n > 1 ? std::vector<std::uint64_t>{c.n / 2, c.n} : std::vector<std::uint64_t>{c.n});
    return c;
}

}  // namespace crescent::explainer
