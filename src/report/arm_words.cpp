// An arm's side follows from the axis that ArmInfo gives its density; one that combines others has none. Of those about
// the normal the one with most rungs in common with the mirror's is taken, of equals the one with the least sum of ln
// RMSE over the regions, at the headline N where both ran, else at the largest they share.
#include "report/arm_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "arms/info.h"
#include "experiment/arm_facts.h"
#include "math/functions.h"

namespace crescent::inline report {
namespace {

/// Sum of log RMSE over the regions; infinite where a run or an error is missing.
double error_of(const Page& page, const ArmPlan& arm, std::uint64_t n) {
    double sum = 0;
    for (const Region& region : page.in.experiment.regions) {
        const auto rmse = page.find.rmse(arm.name, n, region.name);
        if (!rmse || !(*rmse > 0)) return std::numeric_limits<double>::infinity();
        sum += math::log(*rmse);
    }
    return sum;
}

bool is_about(const ArmPlan& arm, PdfAxis axis) {
    const ArmInfo* info = find_arm_info(arm.sampler);
    return info && info->about == axis && !info->combines;
}

std::ptrdiff_t shared_rungs(const ArmPlan& a, const ArmPlan& b) {
    return std::ranges::count_if(a.n, [&](std::uint64_t n) { return std::ranges::find(b.n, n) != b.n.end(); });
}

std::vector<std::string> names_where(const Experiment& e, const std::function<bool(const ArmPlan&)>& is) {
    std::vector<std::string> names;
    for (const ArmPlan& arm : e.arms)
        if (is(arm)) names.push_back("<b>" + escape(arm.name) + "</b>");
    return names;
}

}  // namespace

std::vector<const ArmPlan*> arms_about_normal(const Experiment& experiment) {
    std::vector<const ArmPlan*> out;
    for (const ArmPlan& arm : experiment.arms)
        if (is_about(arm, PdfAxis::normal)) out.push_back(&arm);
    return out;
}

const ArmPlan* arm_about_mirror(const Experiment& experiment) {
    for (const ArmPlan& arm : experiment.arms)
        if (is_about(arm, PdfAxis::mirror)) return &arm;
    return nullptr;
}

ArmPair arm_pair(const Page& page) {
    ArmPair pair;
    pair.narrow = arm_about_mirror(page.in.experiment);
    if (!pair.narrow) return {};
    double least = std::numeric_limits<double>::infinity();
    std::ptrdiff_t most = 0;
    for (const ArmPlan* arm : arms_about_normal(page.in.experiment)) {
        const auto ran = [&](std::uint64_t n) {
            return n > 0 && page.find.run(arm->name, n) && page.find.run(pair.narrow->name, n);
        };
        const std::uint64_t shared = page.find.headline_n();
        const std::uint64_t n = ran(shared) ? shared : page.find.common_n({arm, pair.narrow});
        if (!ran(n)) continue;
        const double error = error_of(page, *arm, n);
        const std::ptrdiff_t rungs = shared_rungs(*arm, *pair.narrow);
        if (!pair.broad || rungs > most || (rungs == most && error < least))
            pair.broad = arm, pair.n = n, least = error, most = rungs;
    }
    return pair ? pair : ArmPair{};
}

std::string run_html(const RunKey& key, const Experiment& experiment) {
    std::string out = fmt::format("{}, <i>N</i> = {}", escape(key.arm), key.n);
    if (tells_s(key.arm, key.s, experiment)) out += fmt::format(", <i>s</i> = {}", shortest(key.s));
    return out;
}

std::string ray_words(const Experiment& experiment) {
    const auto names = names_where(experiment, [](const ArmPlan& arm) { return techniques_of(arm) > 1; });
    if (names.empty()) return {};
    return fmt::format(
        " {} {} two techniques: {} <i>N</i> counts pairs, and at equal <i>N</i> {} two rays for each one "
        "of the others.",
        html::join(names), names.size() == 1 ? "joins" : "join", names.size() == 1 ? "its" : "their",
        names.size() == 1 ? "it sends" : "they send");
}

std::string bias_words(const Experiment& experiment) {
    std::string out;
    for (const ArmPlan& arm : experiment.arms)
        if (const std::string missed = missed_light(arm, experiment); !missed.empty())
            out += fmt::format(
                " <b>{}</b> is biased in this scene: it cannot reach {}. More samples do not bring that light, so "
                "that its RMSE stops falling.",
                escape(arm.name), escape(missed));
    return out;
}

}  // namespace crescent::inline report
