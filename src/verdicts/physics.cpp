// physics: f is reciprocal, reflects no more than it gets, and the white furnace (L = 1) comes out as quadrature says.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "math/spherical.h"
#include "simd/random.h"
#include "stats/moments.h"
#include "stats/quantiles.h"
#include "trials/conditioning.h"
#include "trials/delta.h"
#include "trials/phase.h"
#include "trials/trial_context.h"
#include "trials/unmet.h"
#include "trials/weights.h"
#include "verdicts/energy.h"
#include "verdicts/snell.h"
#include "verdicts/verdict_kind.h"

namespace crescent::inline verdicts {

namespace {

struct Reciprocity {
    std::size_t tried = 0, broken = 0, across = 0;
    bool phase = false;  // f |cos| is what is reciprocal
    Pair worst{};
    double one = 0, other = 0;  // f(a, b), and what f(b, a) makes of it
    int channel = 0;
    /// Of pairs across the surface, in the first channel, from above to below: ln of f(b, a) over what it ought to be,
    /// and of cos a / cos b.
    std::vector<double> off, cosines;
};

/// Directions at large above the surface; below it for odd i, where both sides are asked.
Vec3d at_large(std::uint64_t i, std::uint32_t which, bool both) {
    const Vec2<float> u = draw(17, 0, i, which);
    const bool below = both && (which == 0 ? i & 1 : i & 2);
    const double z = 0.02 + 0.98 * static_cast<double>(u.x);
    return math::spherical(below ? -z : z, 2 * pi * static_cast<double>(u.y));
}

/// Pairs at large, and pairs of w_o with what the sampler draws, where a lobe is high. Those across the surface only
/// where w_o below it is answered for.
std::vector<Pair> pairs_of(const TrialContext& work, bool phase) {
    const bool both = work.traits.wo == Traits::Asked::both;
    std::vector<Pair> pairs;
    for (std::uint64_t i = 0; i < 256; ++i) pairs.push_back({at_large(i, 0, both), at_large(i, 1, both)});
    for (const Draw& d : work.first(0).draws) {
        if (pairs.size() >= 768) break;
        if (d.pdf > 0 && (d.wi.z > 0.02 || (both && d.wi.z < -0.02))) pairs.push_back({work.trial.wo, normalize(d.wi)});
    }
    if (!work.traits.eta &&
        !phase)  // how f scales across the surface is not known; a w_o below may be asked of any sampler
        std::erase_if(pairs, [](const Pair& p) { return p.wo.z * p.wi.z < 0; });
    return pairs;
}

/// What f(b, a) is over f(a, b): 1 on one side of the surface; across it eta^2 = (n_below / n_above)^2 from above to
/// below, for radiance, and one over that for importance (Veach 1997, (5.14)).
double due_ratio(const TrialContext& work, const Pair& p, int channel) {
    if (p.wo.z * p.wi.z > 0 || !work.traits.eta) return 1;
    const double eta2 = sqr(channel_of(*work.traits.eta, channel));
    return (p.wo.z > 0) == !work.traits.importance ? eta2 : 1 / eta2;
}

std::vector<Vec3d> f_of(const TrialContext& work, const std::vector<Pair>& pairs) {
    std::vector<Vec3d> out(pairs.size());
    if (work.traits.channels == 3) {
        work.subject.f_channels(pairs, out);
    } else {
        std::vector<double> y(pairs.size());
        work.subject.f(pairs, y);
        for (std::size_t i = 0; i < y.size(); ++i) out[i] = {y[i], y[i], y[i]};
    }
    return out;
}

/// f(a, b) and f(b, a) of one channel, each times what makes them equal.
struct BothWays {
    double one = 0, other = 0;
    double factor_one = 1, factor_other = 1;  // that are in them
    double off() const { return std::fabs(one - other); }
    double size() const { return std::max(std::fabs(one), std::fabs(other)); }
};

BothWays both_ways(const TrialContext& work, bool phase, const Pair& p, int channel, Vec3d there, Vec3d back) {
    const double factor_one = phase ? std::fabs(p.wi.z) : due_ratio(work, p, channel),
                 factor_other = phase ? std::fabs(p.wo.z) : 1;
    return {
        factor_one * channel_of(there, channel), factor_other * channel_of(back, channel), factor_one, factor_other};
}

/// They differ by more than the rounding of the directions explains.
bool is_broken(const TrialContext& work, const Pair& p, const BothWays& f, int channel) {
    if (f.off() <= 1e-4 * f.size() + 1e-30) return false;
    const double loose = f.factor_one * f_conditioning(work, p.wo, p.wi, f.one / f.factor_one, channel) +
        f.factor_other * f_conditioning(work, p.wi, p.wo, f.other / f.factor_other, channel);
    return !(f.off() <= 1e-4 * f.size() + loose);
}

Reciprocity reciprocity(const TrialContext& work) {
    Reciprocity out;
    if (!work.traits.reciprocal || work.scatter().f()) return out;
    out.phase = is_phase_function(work);
    std::vector<Pair> pairs = pairs_of(work, out.phase), swapped;
    for (const Pair& p : pairs) swapped.push_back({p.wi, p.wo});
    const std::vector<Vec3d> there = f_of(work, pairs), back = f_of(work, swapped);
    double worst = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Pair& p = pairs[i];
        ++out.tried;
        out.across += p.wo.z * p.wi.z < 0;
        if (p.wo.z * p.wi.z < 0 && there[i].x > 0 && back[i].x > 0) {
            const double down = p.wo.z > 0 ? 1 : -1;
            out.off.push_back(down * math::log(back[i].x / (due_ratio(work, p, 0) * there[i].x)));
            out.cosines.push_back(down * math::log(std::fabs(p.wo.z / p.wi.z)));
        }
        bool broken = false;
        for (int c = 0; c < work.traits.channels; ++c) {
            const BothWays f = both_ways(work, out.phase, p, c, there[i], back[i]);
            if (!is_broken(work, p, f, c)) continue;
            broken = true;
            if (f.off() / f.size() <= worst) continue;
            worst = f.off() / f.size();
            out.worst = p;
            out.one = out.phase ? f.one : f.one / f.factor_one;
            out.other = f.other;
            out.channel = c;
        }
        out.broken += broken;
    }
    return out;
}

/// The factor that f lacks or has too often across the surface: eta^2, a cosine, or none that is known.
std::string missing_across(const TrialContext& work, const Reciprocity& r) {
    const auto nine_of_ten = [&](auto&& of) {
        std::size_t inside = 0;
        for (std::size_t i = 0; i < r.off.size(); ++i) inside += std::fabs(of(i)) <= 2e-3;
        return 10 * inside >= 9 * r.off.size();
    };
    if (r.off.size() < 16 || !work.traits.eta) return "";
    const double middle = median_of(r.off), power = middle / (2 * math::log(work.traits.eta->x));
    if (std::round(power) != 0 && std::fabs(power - std::round(power)) < 0.01 &&
        nine_of_ten([&](std::size_t i) { return r.off[i] - middle; }))
        return "eta^2";
    for (double sign : {1.0, -1.0})
        if (nine_of_ten([&](std::size_t i) { return r.off[i] - sign * r.cosines[i]; })) return "cos theta_i";
    return "";
}

/// Says which pair is the worst of those that break reciprocity, and what explains them.
void tell_broken(const TrialContext& work, const Reciprocity& r, Verdict& v) {
    const Vec3d a = r.worst.wo, b = r.worst.wi;
    const bool across = a.z * b.z < 0;
    v.state = State::wrong;
    v.say = fmt::format(
        "f{} is not reciprocal{}: f(a, b) = {:.6g} but f(b, a) = {:.6g}{}, with a = ({:.4g}, {:.4g}, {:.4g}), b = "
        "({:.4g}, {:.4g}, {:.4g}), and for {} of {} pairs.",
        r.phase ? " |cos|" : "", work.traits.channels == 3 ? fmt::format(" in channel {}", r.channel + 1) : "", r.one,
        r.other,
        across && !r.phase
            ? fmt::format(" and not {:.6g} times that, as the index has it", due_ratio(work, r.worst, r.channel))
            : "",
        a.x, a.y, a.z, b.x, b.y, b.z, r.broken, r.tried);
    if (const std::string factor = missing_across(work, r); !factor.empty()) {
        v.evidence["diagnosis"] = factor;
        v.say +=
            fmt::format(" What explains it: {} is left out of f across the surface, or stands there twice.", factor);
    }
}

std::string told_of(const TrialContext& work, const Reciprocity& r) {
    if (work.scatter().f()) return "f is a random estimate, whose reciprocity was not looked at,";
    if (r.phase)
        return fmt::format(
            "f |cos| depends on the angle between w_o and w_i alone, as a phase function does, and is reciprocal over "
            "{} pairs",
            r.tried);
    return work.traits.reciprocal ? fmt::format("f is reciprocal over {} pairs", r.tried)
                                  : "f is said not to be reciprocal, which was not looked at";
}

/// Why the reciprocity of f was not looked at, or not across the surface, and what would make it so; "" where it was.
std::string not_looked_at(const TrialContext& work, const Reciprocity& r) {
    if (work.scatter().f()) return "reciprocity of f, which is a random estimate";
    if (!work.traits.reciprocal) return "reciprocity of f, which is said not to be reciprocal (reciprocal=no)";
    if (!work.whole() || r.phase || r.across > 0) return "";
    return work.traits.eta
        ? "reciprocity across the surface, since w_o below it is not answered for (wo=both)"
        : "reciprocity across the surface, and whether f has its eta^2, since the index is not told (eta=)";
}

/// What f reflects of an even light, and what it lets through.
std::string given_back(const TrialContext& work, const Reciprocity& r, const Integral& albedo) {
    const bool over = work.trial.wo.z > 0;
    const double mirrored = luminance(delta_parts(work, work.first(0)).energy(over ? 1 : -1));
    if (!work.whole()) return fmt::format(" and reflects {:.6f} of an even light", albedo.value + mirrored);
    const std::string both =
        fmt::format(" and reflects {:.6f} of an even light, and lets {:.6f} of one from {} through",
            albedo.bins[over ? 0 : 1] + mirrored, albedo.bins[over ? 1 : 0], over ? "below" : "above");
    if (r.phase) return both;
    if (r.across > 0) return both + fmt::format(" ({} pairs across the surface, with eta^2)", r.across);
    if (!work.traits.reciprocal) return both;
    return both +
        (work.traits.eta ? " (reciprocity across the surface is not looked at: w_o below it is not answered for)"
                         : " (reciprocity across the surface is not looked at: the index is not known)");
}

/// The mean of the weights under L = 1 beside the quadrature, where their tail allows it.
void judge_furnace(const TrialContext& work, const Spread& s, Verdict& v) {
    const std::vector<double>& x = work.first_weights(true);
    const bool even = work.trial.light.fill > 0;  // an arm that aims at disks alone is not asked for an even light
    if (!even || !mean_is_testable(s, tail_of(x), work.trial.theory)) {
        v.say += even ? fmt::format("; the arm's white furnace reads {:.4g}, with too heavy a tail for a test.", s.mean)
                      : ".";
        return;
    }
    const Integral reached = due_mean(work, true);
    const double p = mean_p(s, reached);
    v.evidence["furnace_expected"] = reached.value;
    v.evidence["furnace_p"] = p;
    v.say += fmt::format(
        "; the arm's white furnace reads {:.6g} where quadrature says {:.6g} (p = {:.3g}).", s.mean, reached.value, p);
    if (has_unmet_tail(work, true)) {
        v.say += " ";
        tell_unmet(v, work.unmet(true), reached, x.size());
        return;
    }
    if (!mean_fails(work, p, reached, true)) return;
    v.state = State::wrong;
    v.say = fmt::format(
        "The white furnace reads {:.6g}, quadrature says {:.6g}, and again on a fresh seed.", s.mean, reached.value);
    if (weighs_by_estimates(work)) v.state = State::inconclusive, v.settle = weight_of_estimates;
}

Verdict judge_physics(TrialContext& work) {
    Verdict v = work.verdict("physics", State::right, "");
    if (refracts_elsewhere(work, v) || comes_not_back(work, v)) return v;
    if (!work.subject.has_f()) return work.verdict("physics", State::skipped, "There is no BRDF.");
    const Reciprocity r = reciprocity(work);
    v.evidence["reciprocity_pairs"] = r.tried;
    v.evidence["reciprocity_broken"] = r.broken;
    if (const std::string left = not_looked_at(work, r); !left.empty()) v.evidence["not_looked_at"] = left;
    const Integral albedo = work.incoming(TrialContext::Where::everywhere, true);
    v.evidence["albedo"] = albedo.value;
    v.evidence["albedo_error"] = albedo.error;
    if (r.broken > 0) {
        tell_broken(work, r, v);
        return v;
    }
    if (creates_energy(work, albedo, v)) return v;
    const Spread s = spread(work.first_weights(true));
    v.evidence["furnace_mean"] = s.mean;
    v.evidence["furnace_standard_error"] = s.sd / std::sqrt(s.n);
    v.say = told_of(work, r) + given_back(work, r, albedo);
    if (work.weighs()) judge_furnace(work, s, v);
    else v.say += "; there is nothing to weigh draws by, hence no furnace.";
    return v;
}

/// The white furnace.
std::uint64_t tests_of_physics(const Trial& t) { return t.subject->has_f() ? 1 : 0; }

}  // namespace

constinit const VerdictKind kinds::physics = {.question = "is f a BRDF?",
    .judge = judge_physics,
    .tests = tests_of_physics,
    .asked_of_other_seeds = true,
    .of_all_light = true};

}  // namespace crescent::inline verdicts
