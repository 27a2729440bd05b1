// A sampler of several lobes, by what each of them draws (lobe_draws.h): a factor or another frame of all of p, or a
// factor of what p has of one lobe, where it has the rest as it is drawn.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "simd/scalar.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/lobe_draws.h"

namespace crescent::inline diagnosis {

namespace {

constexpr double left_out = 5e-4;  // what a lobe may draw, of p, where it was not looked for

/// Of all of p.
std::optional<Diagnosis> together(const TrialContext& work, int technique, const LobeDraws& of) {
    std::vector<Ratio> ratios;
    std::vector<WarpPoint> points;
    for (const LobeDraws::At& at : of.at) {
        ratios.push_back({at.point.wi, at.together() / at.pdf, at.error + left_out});
        points.push_back({at.point.wi, 1 / at.together(), at.error + left_out, at.point.u, at.pdf / at.together()});
    }
    if (mostly_one(ratios)) return {};
    if (std::optional<Diagnosis> found = explain(work, ratios); found && comes_to_one(work, technique, *found)) {
        found->means = "what is drawn is pdf(w) times " + found->means;
        return found;
    }
    return turned(work, technique, points, ratios);
}

/// What p has of one lobe integrates to what it has in all, less the others as they are drawn.
bool comes_to_the_rest(
    const TrialContext& work, int technique, const LobeDraws& of, std::size_t lobe, const Diagnosis& found) {
    const SampleBatch& b = work.first(technique);
    const double n = static_cast<double>(b.u.size());
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < b.u.size(); ++i) {
        if (is_null_sample(b.draws[i], b.pdf[i])) continue;
        const double chooses = b.u[i][of.chooser];
        const bool own = chooses >= of.lobes[lobe].from && chooses < of.lobes[lobe].to;
        const double g = own ? found.constant * found.g(b.draws[i].wi) : 1;
        if (!(g > 0)) return false;
        sum += 1 / g, squares += sqr(1 / g);
    }
    const double mass = work.density(technique).mass.value,
                 se = std::sqrt(std::max(squares / n - sqr(sum / n), 0.0) / n);
    return std::fabs(sum / n - mass) < 2e-3 * mass + 5 * se;
}

/// Of one lobe, the others being right.
std::optional<Diagnosis> of_one_lobe(const TrialContext& work, int technique, const LobeDraws& of, std::size_t lobe) {
    constexpr double least = 0.2;  // of p: what is left of less is known too little
    std::vector<Ratio> ratios;
    for (const LobeDraws::At& at : of.at) {
        const double own = at.drawn[lobe], claimed = at.pdf - (at.together() - own);
        if (own > 0 && claimed > least * at.pdf)
            ratios.push_back({at.point.wi, own / claimed, (at.error + left_out) * at.pdf / claimed});
    }
    std::optional<Diagnosis> found = explain(work, ratios);
    if (!found || !found->g || found->name == "a constant") return {};
    if (!comes_to_the_rest(work, technique, of, lobe, *found)) return {};
    found->means = fmt::format(
        "of what u{} chooses, the lobe from {:.4g} to {:.4g} is drawn as pdf(w) has it times {}, "
        "and the rest as pdf(w) has it",
        of.chooser + 1, of.lobes[lobe].from, of.lobes[lobe].to, found->means);
    found->name += " in one lobe";
    return found;
}

}  // namespace

std::optional<Diagnosis> diagnose_several_lobes(const TrialContext& work, int technique) {
    const std::optional<LobeDraws> of = lobe_draws_of(work, technique);
    if (!of) return {};
    if (std::optional<Diagnosis> found = together(work, technique, *of)) return found;
    if (std::optional<Diagnosis> found = diagnose_shares(work, technique, *of)) return found;
    for (std::size_t lobe = 0; lobe < of->lobes.size(); ++lobe)
        if (std::optional<Diagnosis> found = of_one_lobe(work, technique, *of, lobe)) return found;
    return {};
}

}  // namespace crescent::inline diagnosis
