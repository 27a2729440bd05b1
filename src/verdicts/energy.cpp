// Whether f creates energy: what it reflects and lets through of an even light, by channel. Where the index is told,
// what comes through is counted as power: radiance scales by (n_o / n_i)^2 across the surface, importance not at all
// (Veach 1997, section 5.2; Walter et al. 2007, section 5.2). Where it is not, an albedo over the whole sphere may
// exceed 1 and be right (transmission.cpp), unless f is the same both ways across the surface: then no index scales it.
// What a delta part sends straight on, towards -w_o, no index scales, and a phase function has none.
#include "verdicts/energy.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "trials/delta.h"
#include "trials/phase.h"
#include "trials/transmission.h"
#include "trials/trial_context.h"

namespace crescent::inline verdicts {

namespace {

constexpr double allowed = 1 + 1e-4;

/// What one channel gives to the upper and the lower half, and what that is known to.
struct Given {
    double above = 0, below = 0, error = 0;
    double straight = 0;  // of delta parts at -w_o, which cross no boundary that scales them: not in the halves
    double holes = 0;     // the same along the normal, where a smooth boundary refracts to -w_o too: in the halves
};

struct Scales {
    double through = 1;  // what comes through, as power
    bool known = false;
};

/// f is the same both ways across the surface, where the sampler draws: no index scales it.
bool is_alike_across(const TrialContext& work) {
    constexpr std::size_t fewest = 16, most = 64;
    constexpr double same = 1e-3;
    if (work.traits.wo != Traits::Asked::both || !work.subject.has_f()) return false;
    const SampleBatch& b = work.first(0);
    std::vector<Pair> there, back;
    for (std::size_t i = 0; i < b.draws.size() && there.size() < most; ++i) {
        const Vec3d wo = work.trial.wo, wi = b.draws[i].wi;
        if (is_null_sample(b.draws[i], b.pdf[i]) || !(wi.z * wo.z < 0)) continue;
        there.push_back({wo, wi}), back.push_back({wi, wo});
    }
    std::vector<double> f(there.size()), g(there.size());
    work.subject.f(there, f);
    work.subject.f(back, g);
    std::size_t alike = 0;
    for (std::size_t i = 0; i < f.size(); ++i) alike += f[i] > 0 && std::fabs(g[i] - f[i]) < same * f[i];
    return alike >= fewest && alike == f.size();
}

/// unscaled: no index scales f.
Scales scales_of(const TrialContext& work, bool unscaled, int channel) {
    if (!work.traits.eta) return {1, unscaled};
    const double eta2 = sqr(channel_of(*work.traits.eta, channel));
    if (work.traits.importance) return {1, true};
    return {work.trial.wo.z > 0 ? eta2 : 1 / eta2, true};
}

bool too_much(const TrialContext& work, const Given& g, bool unscaled, int channel, const char* tag, Verdict& v) {
    const bool over = work.trial.wo.z > 0;
    const double back = over ? g.above : g.below, through = over ? g.below : g.above;
    if (back - g.error > allowed) {
        v.state = State::wrong;
        v.say = fmt::format("The surface reflects {:.6f} of what it gets{}: f creates energy.", back, tag);
        return true;
    }
    if (g.straight > 0 && back + g.straight - g.error > allowed) {
        v.state = State::wrong;
        v.say = fmt::format(
            "The surface reflects {:.6f} of what it gets and lets {:.6f} straight through{}: it creates energy.", back,
            g.straight, tag);
        return true;
    }
    const Scales scale = scales_of(work, unscaled, channel);
    if (!scale.known || !work.whole()) return false;
    const double passed = scale.through * (through - g.holes) + g.holes, power = back + g.straight + passed;
    v.evidence[fmt::format(
        "power{}", channel < 0 || work.traits.channels == 1 ? "" : fmt::format("_{}", channel + 1))] = power;
    if (power - (1 + scale.through) * g.error <= allowed) return false;
    v.state = State::wrong;
    v.say = fmt::format("Of the power that arrives the surface reflects {:.6f} and lets {:.6f} through{}{}.", back,
        g.straight + passed, tag,
        work.traits.eta ? ", by the index that is told: f creates energy, or scales by eta^2 the wrong way"
            : is_phase_function(work) ? ": f |cos| creates energy, as a phase function that integrates to more than 1"
                                      : ": f is the same both ways across it, so that no index scales it, and creates "
                                        "energy");
    return true;
}

/// Where the index is not known: more than there is, in both ways of counting.
bool too_much_either_way(const TrialContext& work, const Given& g, Verdict& v) {
    if (!work.whole() || work.trial.wo.z < 0 || work.traits.eta || g.above + g.below + g.straight - g.error <= allowed)
        return false;
    for (Vec3d b : drawn_below(work)) {
        const Integral through = from_below(work, b);
        v.evidence["from_below"] = through.value;
        if (through.value - through.error <= allowed) continue;
        v.state = State::wrong;
        v.say = fmt::format(
            "The surface gives {:.6f} of an even light from both sides, and light from ({:.4g}, {:.4g}, {:.4g}) below "
            "comes up as {:.6f} of itself: f creates energy, whatever the indices are.",
            g.above + g.below + g.straight, b.x, b.y, b.z, through.value);
        return true;
    }
    return false;
}

/// At the normal a smooth boundary refracts to -w_o.
bool is_along_normal(Vec3d wo) {
    constexpr double slanted = 0.01;
    return std::sqrt(wo.x * wo.x + wo.y * wo.y) < slanted;
}

/// Of delta parts at -w_o.
Vec3d straight_through(const TrialContext& work, const DeltaParts& deltas) {
    constexpr double same = 1e-5;
    const Vec3d wo = work.trial.wo;
    Vec3d sum{};
    if (!work.whole()) return sum;
    for (const DeltaPart& p : deltas.parts)
        if (length(p.wi + wo) < same) sum = sum + p.weight * p.q;
    return sum;
}

/// Of the first delta part that goes straight on, as through a hole, and not where the index bends it, at a slanted w_o
/// on the same side.
Vec3d through_holes(const TrialContext& work) {
    constexpr std::size_t asked = 512;
    const Vec3d wo = tilt(work.trial.wo.z > 0 ? 30 : 150);
    const std::vector<Numbers>& all = work.first(0).u;
    const std::span<const Numbers> u = std::span(all).first(std::min(all.size(), asked));
    std::vector<Draw> draws(u.size());
    work.subject.sample(0, wo, u, draws);
    for (const Draw& d : draws) {
        if (!(d.delta > 0) || !(length(d.wi + wo) < 1e-5)) continue;
        const double w = d.weight.value_or(0);
        return (work.traits.channels == 3 ? d.weights : Vec3d{w, w, w}) * d.delta;
    }
    return {};
}

Given given(const TrialContext& work, const Integral& albedo, const DeltaParts& deltas, int channel) {
    const auto of = [&](Vec3d v) { return channel < 0 ? luminance(v) : channel_of(v, channel); };
    Given out{work.whole() ? albedo.bins[0] : albedo.value, work.whole() ? albedo.bins[1] : 0, albedo.error};
    out.above += of(deltas.energy(1));
    if (work.whole()) out.below += of(deltas.energy(-1));
    const double onward = of(straight_through(work, deltas));
    if (is_along_normal(work.trial.wo)) {
        if (!(onward > 0) || !work.subject.draws_at_will()) return out;
        const double slanted = of(through_holes(work));
        out.holes =
            slanted > 0.5 * onward ? onward : slanted;  // all of it, as by a pane, which lets other shares through
        return out;
    }
    out.straight = onward;
    (work.trial.wo.z > 0 ? out.below : out.above) -= out.straight;
    return out;
}

}  // namespace

bool creates_energy(const TrialContext& work, const Integral& albedo, Verdict& v) {
    const DeltaParts deltas = delta_parts(work, work.first(0));
    const Given all = given(work, albedo, deltas, -1);
    if (work.whole()) v.evidence["albedo_above"] = all.above, v.evidence["albedo_below"] = all.below;
    if (all.straight > 0) v.evidence["straight_through"] = all.straight;
    const bool unscaled = work.whole() && !work.traits.eta && (is_phase_function(work) || is_alike_across(work));
    if (!deltas.parts.empty()) v.evidence["albedo_of_delta_parts"] = luminance(deltas.energy(0));
    if (work.traits.channels == 3) {
        const char* names[] = {" in the first channel", " in the second channel", " in the third channel"};
        for (int c = 0; c < 3; ++c) {
            const Integral one = work.albedo_of(c);
            v.evidence[fmt::format("albedo_{}", c + 1)] = one.value;
            if (too_much(work, given(work, one, deltas, c), unscaled, c, names[c], v)) return true;
        }
    } else if (too_much(work, all, unscaled, 0, "", v)) {
        return true;
    }
    return too_much_either_way(work, all, v);
}

}  // namespace crescent::inline verdicts
