// density: the draws follow p, by the chi-square of fit.h; no block of them is too crowded; delta parts are drawn as
// often as they say.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <optional>

#include "math/functions.h"
#include "stats/bins.h"
#include "trials/delta.h"
#include "verdicts/clumps.h"
#include "verdicts/fit.h"
#include "verdicts/implied.h"
#include "verdicts/verdict_kind.h"
#include "verdicts/worst_bin.h"

namespace crescent::inline verdicts {

namespace {

std::string coordinates(const Density& d) {
    return d.about_n ? "cos theta x phi about n" : "rings x turns about the lobe";
}

/// Delta parts are few, and are drawn as often as they say.
bool deltas_are_wrong(const TrialContext& work, const DeltaParts& deltas, Verdict& v) {
    if (deltas.parts.empty()) return false;
    v.evidence["delta_parts"] = evidence_of(deltas);
    if (deltas.scattered) {
        v.state = State::wrong;
        v.say = fmt::format(
            "Draws that are said to be of delta parts go to more than {} directions or come with as many "
            "probabilities: what has a density is no delta part.",
            deltas.parts.size());
        return true;
    }
    const double p = delta_share_p(deltas, work.first(0));
    v.evidence["p_delta"] = p;
    if (!work.fails(p, [&](int round) {
            const SampleBatch fresh = work.draw(0, round);
            return delta_share_p(delta_parts(work, fresh), fresh);
        }))
        return false;
    v.state = State::wrong;
    v.evidence["parts_off"] = true;
    v.say = "Delta parts are not drawn as often as they say, and again on a fresh seed:" + told(deltas);
    return true;
}

using OfFit = std::function<double(const FitToDensity&)>;

std::string told(const Pearson& of, const char* where) {
    return fmt::format("{}: chi-square {:.4g} on {:g} degrees, p = {:.2g}", where, of.statistic, of.degrees, of.p);
}

/// What the least likely of the tests that failed says; "" where none did.
std::string mismatch(const FitToDensity& f, const std::function<bool(const OfFit&)>& fails) {
    std::string say;
    double least = 2;
    const auto look = [&](const OfFit& p, const std::string& text) {
        if (fails(p) && p(f) < least) least = p(f), say = text;
    };
    look([](const FitToDensity& x) { return x.joint.p; }, told(f.joint, "over the whole sphere"));
    look([](const FitToDensity& x) { return x.rings.p; }, told(f.rings, "along the angle from the axis"));
    look([](const FitToDensity& x) { return x.sectors.p; }, told(f.sectors, "around the axis"));
    look([](const FitToDensity& x) { return x.outside_p; },
        fmt::format("where p integrates to next to nothing: {:.0f} fell there, {:.2g} are due, p = {:.2g}",
            f.outside_seen, f.outside_due, f.outside_p));
    if (f.heights_p)
        look([](const FitToDensity& x) { return x.heights_p.value_or(1); },
            fmt::format("from texel to texel: the mean of ln p over them is off by {:.1f} standard errors, p = {:.2g}",
                f.heights_off, *f.heights_p));
    return say;
}

constexpr double steps_of_a_bin = 8;  // that it takes for draws to show p and not the stairs that they come on

/// Where one step of u takes a direction through an eighth of a bin or more, draws show the steps of u beside p.
struct Grain {
    double step = 0, bin = 0;  // radians; step 0: bins are wide enough
    std::size_t ring = 0;
    bool own = false;         // steps of the sampler's own random numbers
    bool off_beyond = false;  // in bins of many steps the draws do not follow p either
};

Grain grain_of_u(const TrialContext& work, int technique, const Density& d, const FitToDensity& f) {
    const std::size_t worst = worst_bin(f.observed, f.expected), sectors = static_cast<std::size_t>(d.sectors),
                      ring = worst / sectors;
    const SampleBatch& b = work.first(technique);
    const std::vector<Vec2d>& at = work.coordinates_of(b, d.map);
    std::vector<std::size_t> inside;
    for (std::size_t i = 0; i < b.draws.size() && inside.size() < 32; ++i)
        if (!is_null_sample(b.draws[i], b.pdf[i]) && d.bin_of(at[i]) == worst) inside.push_back(i);
    const double step = least_step(work, technique, b, inside), from = d.rings[ring], to = d.rings[ring + 1],
                 wide = math::acos(std::clamp(1 - to, -1.0, 1.0)) - math::acos(std::clamp(1 - from, -1.0, 1.0)),
                 sin = std::sqrt(std::max(to * (2 - to), 0.0)),
                 least = std::min(wide, 2 * pi * sin / static_cast<double>(d.sectors));
    constexpr double seam = pi / 180;  // of a number that chooses: no rounding moves a direction so far
    if (!(steps_of_a_bin * step > least) || !(least > 0) || step > seam) return {};
    return {step, least, ring, work.traits.own_random, false};
}

std::string told(const Grain& g) {
    if (!(g.step > 0)) return "";
    return fmt::format(" {} {:.2g} deg, through a bin {:.2g} deg wide: {}.",
        g.own ? "Directions that come again lie apart there by"
              : "u comes in steps of 2^-24, of which one moves the direction there by",
        g.step * 180 / pi, g.bin * 180 / pi,
        g.off_beyond ? "bins of 32 steps show it too"
            : g.own  ? "it may be such steps alone that the draws show, not p"
                     : "it may be the steps of u alone that the draws show, not p");
}

void note(const TrialContext& work, int technique, const FitToDensity& f, Verdict& v) {
    const std::string suffix = work.suffix(technique);
    v.evidence["coordinates" + suffix] = coordinates(work.density(technique));
    v.evidence["chi2" + suffix] = f.joint.statistic;
    v.evidence["degrees" + suffix] = f.joint.degrees;
    v.evidence["draws" + suffix] = work.first(technique).draws.size();
    for (const auto& [name, p] : {std::pair("p", f.joint.p), {"p_rings", f.rings.p}, {"p_sectors", f.sectors.p},
             {"p_outside", f.outside_p}, {"p_clump", f.clump.p}})
        v.evidence[name + suffix] = p;
    if (f.heights_p) {
        const LogHeights& due = *work.density(technique).mass.heights;
        v.evidence["p_heights" + suffix] = *f.heights_p;
        v.evidence["heights" + suffix] = {{"z", f.heights_off}, {"due", due.mean}, {"variance", due.variance}};
    }
    v.evidence["pools" + suffix] = f.joint.pools;
    v.evidence["empty_bins" + suffix] = f.joint.empty;
    v.evidence["drawn_in_empty_bins" + suffix] = f.joint.empty_observed;
}

/// What `mismatch` says of the draws of a technique, on the first seed and on a fresh one.
std::string twice_off(const TrialContext& work, int t, const Density& d, const FitToDensity& f) {
    std::optional<FitToDensity> fresh;
    return mismatch(f, [&](const OfFit& p) {
        return work.fails(p(f), [&](int round) {
            if (!fresh) fresh = fit_to_density(work, t, d, work.draw(t, round));
            return p(*fresh);
        });
    });
}

/// Bins that are narrower than eight steps of u are joined to eight: where draws follow p over these, `f` is of these.
/// A stair that lies across an edge is half a step too much for the bin on one side: it is off by as much in bins of
/// four times the width, a quarter of the share, and a p that is wrong all along by the same share as before.
bool follow_in_wider_bins(const TrialContext& work, int t, Grain& grain, FitToDensity& f, Verdict& v) {
    if (!(grain.step > 0)) return false;
    for (const double steps : {steps_of_a_bin, 4 * steps_of_a_bin}) {
        const Density wide = joined(work.density(t), steps * grain.step, grain.ring);
        FitToDensity coarse = fit_to_density(work, t, wide, work.first(t));
        if (coarse.joint.pools < 2) return false;
        grain.off_beyond = !twice_off(work, t, wide, coarse).empty();
        if (grain.off_beyond) continue;
        f = std::move(coarse);
        note(work, t, f, v);
        v.evidence["joined_to_deg" + work.suffix(t)] = steps * grain.step * 180 / pi;
        return true;
    }
    return false;
}

/// The draws of a technique do not follow p, on the first seed and on a fresh one; says so. `f` may become that of
/// wider bins.
bool draws_are_off(const TrialContext& work, int t, FitToDensity& f, Verdict& v) {
    const Density& d = work.density(t);
    const Clump clump = f.clump;
    if (const std::string fault = twice_off(work, t, d, f); !fault.empty()) {
        Grain grain = grain_of_u(work, t, d, f);
        if (follow_in_wider_bins(work, t, grain, f, v)) return false;
        v.state = State::wrong;
        v.say = fmt::format(
            "The draws do not follow p {} ({}), and again on a fresh seed with more draws.", fault, coordinates(d));
        tell_worst(v, d, f.observed, f.expected);
        v.say += told(grain);
        return true;
    }
    if (!work.fails(clump.p, [&](int round) { return fit_to_density(work, t, d, work.draw(t, round)).clump.p; }))
        return false;
    tell_clump(v, clump);
    return true;
}

/// Draws that nothing accuses: how well they fit, or that they are too few.
void tell_fit(const TrialContext& work, int t, const FitToDensity& f, Verdict& v) {
    const std::size_t draws = work.first(t).draws.size();
    v.evidence["unseen_in_one_bin" + work.suffix(t)] =
        unseen_share(f.expected, f.joint.degrees, static_cast<double>(draws), work.settings.screen);
    v.say = fmt::format("{} draws fall as p says: chi-square {:.4g} on {:g} degrees, p = {:.3g} ({}).", draws,
        f.joint.statistic, f.joint.degrees, f.joint.p, coordinates(work.density(t)));
    const std::string joined = "joined_to_deg" + work.suffix(t);
    if (v.evidence.contains(joined))
        v.say += fmt::format(
            " Bins are joined to {:.2g} deg: the steps of u lead no finer there.", v.evidence[joined].get<double>());
    if (f.joint.pools >= 2) return;
    v.state = State::inconclusive;
    v.say = fmt::format("Fewer than two bins expect 5 draws: {} draws are too few for a chi-square test.", draws);
    v.settle = "More draws, or a sampler that draws something more often.";
}

Verdict judge_density(TrialContext& work) {
    Verdict v = work.verdict("density", State::right, "");
    const DeltaParts deltas = delta_parts(work, work.first(0));
    if (deltas_are_wrong(work, deltas, v)) return v;
    if (!work.traits.has_pdf) return implied_density(work, std::move(v));
    for (int t = 0; t < work.subject.techniques(); ++t) {
        const Density& d = work.density(t);
        if (d.mass.value == 0 && !deltas.parts.empty() && work.first(t).deltas == work.first(t).nothing) {
            v.say = "Every draw is of a delta part, or none." + told(deltas);
            return v;
        }
        if (!(d.mass.value > 0) || !std::isfinite(d.mass.value))
            return work.verdict("density", State::skipped,
                fmt::format("p integrates to {:g}: there is nothing to compare draws with.", d.mass.value));
        FitToDensity f = fit_to_density(work, t, d, work.first(t));
        note(work, t, f, v);
        if (work.settings.pictures && t == 0)
            work.maps.push_back({work.trial.arm, work.trial.text(), coordinates(d),
                static_cast<int>(d.rings.size()) - 1, d.sectors, f.observed, f.expected, d.rings});
        if (draws_are_off(work, t, f, v)) return v;
        tell_fit(work, t, f, v);
    }
    v.say += told(deltas);
    return v;
}

/// Of each technique the chi-square over the sphere, over rings and over sectors, what is drawn where p is next to
/// nothing, and of a sky the mean of ln p; and the shares of delta parts.
std::uint64_t tests_of_density(const Trial& t) {
    const Traits traits = t.subject->traits();
    return (traits.wo == Traits::Asked::none ? 6 : 5) * static_cast<std::uint64_t>(t.subject->techniques()) +
        (traits.delta ? 1 : 0);
}

}  // namespace

constinit const VerdictKind kinds::density = {.question = "do the draws follow p?",
    .judge = judge_density,
    .tests = tests_of_density,
    .asked_of_other_seeds = true};

}  // namespace crescent::inline verdicts
