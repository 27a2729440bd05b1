// density: the draws follow p, by Pearson's chi-square over bins whose expected counts come from adaptive cubature in
// double; bins are pooled along their ring, then outwards, until 5 are expected in each.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <utility>

#include "math/distributions.h"
#include "verdicts/delta.h"
#include "verdicts/ordered.h"
#include "verdicts/verdict_kind.h"

namespace crescent::inline verdicts {

namespace {

struct Pearson {
    double statistic = 0, degrees = -1;  // one degree goes to the total
    double p = 1;
    std::size_t pools = 0, empty = 0;  // pools tested; bins with an expectation below 1e-6
    double empty_observed = 0, empty_expected = 0;
};

/// Pools neighbours until 5 are expected. What cannot reach 5 in the end joins the last pool.
/// `slack`: what each expectation is known to, by cubature and where p was tabulated; it is taken off the difference.
Pearson pearson(
    const std::vector<double>& observed, const std::vector<double>& expected, const std::vector<double>& slack) {
    struct Pool {
        double seen, due, slack;
    };
    std::vector<Pool> pools;
    double o = 0, e = 0, s = 0;
    Pearson out;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] < 1e-6) {
            ++out.empty;
            out.empty_observed += observed[i];
            out.empty_expected += std::max(expected[i], 0.0);
        }
        o += observed[i];
        e += std::max(expected[i], 0.0);
        s += slack[i];
        if (e >= 5) {
            pools.push_back({o, e, s});
            o = e = s = 0;
        }
    }
    if (pools.empty()) return out;
    pools.back().seen += o;
    pools.back().due += e;
    pools.back().slack += s;
    for (const Pool& p : pools) out.statistic += sqr(std::max(std::fabs(p.seen - p.due) - p.slack, 0.0)) / p.due;
    out.pools = pools.size();
    out.degrees = static_cast<double>(pools.size()) - 1;
    out.p = chi_squared_p(out.statistic, out.degrees);
    return out;
}

struct Fit {
    Pearson joint, rings, sectors;
    double outside_p = 1;  // of as many draws where p integrates to next to nothing
    double outside_seen = 0, outside_due = 0;
    Clump clump;
    std::vector<double> observed, expected;
};

std::vector<double> count(const TrialContext& work, const Density& d, const SampleBatch& b, double& nothing) {
    std::vector<double> bins(d.mass.bins.size());
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        work.subject.make_way(1);
        if (is_null_sample(b.draws[i], b.pdf[i])) {
            ++nothing;
            continue;
        }
        ++bins[d.bin_of(d.map.coordinates(b.draws[i].wi))];
    }
    return bins;
}

Fit fit(const TrialContext& work, int technique, const Density& d, const SampleBatch& b) {
    Fit out;
    const bool estimates = work.scatter().pdf();
    if (!estimates) out.clump = densest_clump(work, technique, d, b);  // which needs p itself at the draws
    double nothing = 0;
    out.observed = count(work, d, b, nothing);
    const double n = static_cast<double>(b.draws.size());
    const std::size_t sectors = static_cast<std::size_t>(d.sectors), rings = d.rings.size() - 1;
    // Left by p: what draws nothing. Scaled to the share that was drawn, so that the normalisation is not judged twice.
    const bool table =
        d.doubts > 0 && std::fabs(d.mass.value + d.nothing - 1) <= d.doubts;  // its sum says less than its bins
    const double scale = table ? n : n * (1 - d.nothing) / d.mass.value;
    std::vector<double> by_ring(rings), by_sector(sectors), due_ring(rings), due_sector(sectors),
        slack(d.mass.bins.size()), slack_ring(rings), slack_sector(sectors);
    for (std::size_t i = 0; i < slack.size(); ++i) {
        slack[i] = scale *
            ((d.doubt.empty() ? 0 : d.doubt[i]) + (estimates ? 1 : 3) * d.mass.bin_errors[i] +
                2 * d.nothing_se * d.mass.bins[i]);
        slack_ring[i / sectors] += estimates ? sqr(slack[i]) : slack[i];
        slack_sector[i % sectors] += estimates ? sqr(slack[i]) : slack[i];
    }
    if (estimates)  // three standard errors each, of points of their own
        for (std::vector<double>* sums : {&slack_ring, &slack_sector})
            for (double& v : *sums) v = std::sqrt(v);
    for (std::size_t i = 0; i < d.mass.bins.size(); ++i) {
        const double due = scale * d.mass.bins[i];
        out.expected.push_back(due);
        by_ring[i / sectors] += out.observed[i];
        by_sector[i % sectors] += out.observed[i];
        due_ring[i / sectors] += due;
        due_sector[i % sectors] += due;
    }
    std::vector<double> observed = out.observed, expected = out.expected;
    // Rings that expect next to nothing: the Poisson law; the error of p is granted, which no bin states so far out.
    double seen = 0, due = 0;
    for (std::size_t i = 0; i < rings; ++i) {
        if (due_ring[i] >= std::max(1.0, 1e-5 * n)) continue;
        seen += std::exchange(by_ring[i], 0);
        due += std::exchange(due_ring[i], 0);
        for (std::size_t k = i * sectors; k < (i + 1) * sectors; ++k) {
            by_sector[k % sectors] -= std::exchange(observed[k], 0);
            due_sector[k % sectors] -= std::exchange(expected[k], 0);
        }
    }
    out.outside_seen = seen, out.outside_due = due;
    if (seen > 0) out.outside_p = math::poisson_tail(due + n * (1e-4 + d.mass.error + d.doubts), seen);
    if (n * d.nothing >= 5) {  // nothing drawn is one more bin
        observed.insert(observed.begin(), nothing);
        expected.insert(expected.begin(), n * d.nothing);
        slack.insert(slack.begin(), 2 * n * d.nothing_se);
    }
    out.joint = pearson(observed, expected, slack);
    out.rings = pearson(by_ring, due_ring, slack_ring);
    out.sectors = pearson(by_sector, due_sector, slack_sector);
    out.joint.empty_observed += seen;
    return out;
}

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
    v.say = "Delta parts are not drawn as often as they say, and again on a fresh seed:" + told(deltas);
    return true;
}

using OfFit = std::function<double(const Fit&)>;

std::string told(const Pearson& of, const char* where) {
    return fmt::format("{}: chi-square {:.4g} on {:g} degrees, p = {:.2g}", where, of.statistic, of.degrees, of.p);
}

/// What the least likely of the tests that failed says; "" where none did.
std::string mismatch(const Fit& f, const std::function<bool(const OfFit&)>& fails) {
    std::string say;
    double least = 2;
    const auto look = [&](const OfFit& p, const std::string& text) {
        if (fails(p) && p(f) < least) least = p(f), say = text;
    };
    look([](const Fit& x) { return x.joint.p; }, told(f.joint, "over the whole sphere"));
    look([](const Fit& x) { return x.rings.p; }, told(f.rings, "along the angle from the axis"));
    look([](const Fit& x) { return x.sectors.p; }, told(f.sectors, "around the axis"));
    look([](const Fit& x) { return x.outside_p; },
        fmt::format("where p integrates to next to nothing: {:.0f} fell there, {:.2g} are due, p = {:.2g}",
            f.outside_seen, f.outside_due, f.outside_p));
    return say;
}

/// Where one step of u takes a direction through half a bin or more, draws show no more of p than the steps of u.
std::string grain_of_u(const TrialContext& work, int technique, const Density& d, const Fit& f) {
    const std::size_t worst = worst_bin(f.observed, f.expected), sectors = static_cast<std::size_t>(d.sectors),
                      ring = worst / sectors;
    const SampleBatch& b = work.first(technique);
    std::vector<std::size_t> inside;
    for (std::size_t i = 0; i < b.draws.size() && inside.size() < 32; ++i)
        if (!is_null_sample(b.draws[i], b.pdf[i]) && d.bin_of(d.map.coordinates(b.draws[i].wi)) == worst)
            inside.push_back(i);
    const double step = least_step(work, technique, b, inside), from = d.rings[ring], to = d.rings[ring + 1],
                 wide = math::acos(std::clamp(1 - to, -1.0, 1.0)) - math::acos(std::clamp(1 - from, -1.0, 1.0)),
                 sin = std::sqrt(std::max(to * (2 - to), 0.0)),
                 least = std::min(wide, 2 * pi * sin / static_cast<double>(d.sectors));
    if (!(step > 0.5 * least)) return "";
    const bool own = work.traits.own_random;
    return fmt::format(" {} {:.2g} deg, through a bin {:.2g} deg wide: it may be {} alone that the draws show, not p.",
        own ? "Directions that come again lie apart there by"
            : "u comes in steps of 2^-24, of which one moves the direction there by",
        step * 180 / pi, least * 180 / pi, own ? "such steps" : "the steps of u");
}

Verdict judge(TrialContext& work) {
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
        const Fit f = fit(work, t, d, work.first(t));
        const std::string tag = work.subject.techniques() > 1 ? fmt::format("_{}", t + 1) : "";
        v.evidence["coordinates" + tag] = coordinates(d);
        v.evidence["chi2" + tag] = f.joint.statistic;
        v.evidence["degrees" + tag] = f.joint.degrees;
        const std::size_t draws = work.first(t).draws.size();
        v.evidence["draws" + tag] = draws;
        for (const auto& [name, p] : {std::pair("p", f.joint.p), {"p_rings", f.rings.p}, {"p_sectors", f.sectors.p},
                 {"p_outside", f.outside_p}, {"p_clump", f.clump.p}})
            v.evidence[name + tag] = p;
        v.evidence["pools" + tag] = f.joint.pools;
        v.evidence["empty_bins" + tag] = f.joint.empty;
        v.evidence["drawn_in_empty_bins" + tag] = f.joint.empty_observed;
        if (work.settings.pictures && t == 0)
            work.maps.push_back({work.trial.arm, work.trial.text(), coordinates(d),
                static_cast<int>(d.rings.size()) - 1, d.sectors, f.observed, f.expected, d.rings});
        std::optional<Fit> fresh;
        const auto of = [&](const OfFit& which) {
            return work.fails(which(f), [&](int round) {
                if (!fresh) fresh = fit(work, t, d, work.draw(t, round));
                return which(*fresh);
            });
        };
        if (const std::string fault = mismatch(f, of); !fault.empty()) {
            v.state = State::wrong;
            v.say = fmt::format(
                "The draws do not follow p {} ({}), and again on a fresh seed with more draws.", fault, coordinates(d));
            tell_worst(v, d, f.observed, f.expected);
            v.say += grain_of_u(work, t, d, f);
            return v;
        }
        if (of([](const Fit& x) { return x.clump.p; })) {
            tell_clump(v, f.clump);
            return v;
        }
        v.evidence["unseen_in_one_bin" + tag] =
            unseen_share(f.expected, f.joint.degrees, static_cast<double>(draws), work.settings.screen);
        v.say = fmt::format("{} draws fall as p says: chi-square {:.4g} on {:g} degrees, p = {:.3g} ({}).", draws,
            f.joint.statistic, f.joint.degrees, f.joint.p, coordinates(d));
        if (f.joint.pools < 2) {
            v.state = State::inconclusive;
            v.say =
                fmt::format("Fewer than two bins expect 5 draws: {} draws are too few for a chi-square test.", draws);
            v.settle = "More draws, or a sampler that draws something more often.";
        }
    }
    v.say += told(deltas);
    return v;
}

/// Of each technique the chi-square over the sphere, over rings and over sectors, and what is drawn where p is next to
/// nothing; and the shares of delta parts.
std::uint64_t tests(const Trial& t) {
    return 5 * static_cast<std::uint64_t>(t.subject->techniques()) + (t.subject->traits().delta ? 1 : 0);
}

}  // namespace

constinit const VerdictKind kinds::density = {
    .question = "do the draws follow p?", .judge = judge, .tests = tests, .asked_of_other_seeds = true};

}  // namespace crescent::inline verdicts
