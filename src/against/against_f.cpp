// f of two samplers beside one another, where both are asked, and the power of their delta parts.
#include "against/against_f.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/spherical.h"
#include "simd/random.h"
#include "trials/conditioning.h"
#include "trials/delta.h"
#include "trials/trial_context.h"

namespace crescent::inline against {

namespace {

/// Where f of both is known.
struct Shared {
    std::vector<Vec3d> wi;
    std::vector<double> a, b;
    bool at_draws = false;  // of A, whose f is known there alone
};

void add_drawn(std::vector<Vec3d>& wi, const TrialContext& work) {
    const auto& draws = work.first(0).draws;
    for (std::size_t i = 0, n = 0; i < draws.size() && n < 256; ++i)
        if (draws[i].pdf > 0 && work.counts(draws[i].wi)) wi.push_back(normalize(draws[i].wi)), ++n;
}

/// Directions all over the upper half, and where either draws; or A's draws.
Shared f_of_both(const TrialContext& a, const TrialContext& b) {
    Shared out;
    out.at_draws = !a.subject.has_f();
    if (out.at_draws) {
        for (const Draw& d : a.first(0).draws)
            if (d.pdf > 0 && d.f && a.counts(d.wi)) out.wi.push_back(normalize(d.wi)), out.a.push_back(*d.f);
    } else {
        for (std::uint64_t i = 0; i < 256; ++i) {
            const Vec2<float> u = draw(23, 0, i, 0);
            out.wi.push_back(
                math::spherical(0.02 + 0.98 * static_cast<double>(u.x), 2 * pi * static_cast<double>(u.y)));
        }
        add_drawn(out.wi, a);
        add_drawn(out.wi, b);
        out.a = a.f(out.wi);
    }
    out.b = b.f(out.wi);
    return out;
}

struct Difference {
    std::size_t count = 0, worst = 0;
    double most = 0;  // relative
};

/// More than 1e-4 of f and what rounding moves it by.
Difference difference(const TrialContext& a, const TrialContext& b, const Shared& both) {
    Difference out;
    for (std::size_t i = 0; i < both.wi.size(); ++i) {
        const double fa = both.a[i], fb = both.b[i], off = std::fabs(fa - fb),
                     size = std::max(std::fabs(fa), std::fabs(fb));
        if (off <= 1e-4 * size + 1e-30) continue;
        const Vec3d wi = both.wi[i];
        const double loose = both.at_draws ? 4 * a.direction_resolution() * size / std::max(std::fabs(wi.z), 1e-9)
                                           : f_conditioning(a, a.trial.wo, wi, fa);
        if (out.count < 4096 && off <= 1e-4 * size + loose + f_conditioning(b, b.trial.wo, wi, fb)) continue;
        ++out.count;
        if (off / size > out.most) out.most = off / size, out.worst = i;
    }
    return out;
}

/// What the parts of one sampler make of the light from w, by channel.
Vec3d power_towards(const DeltaParts& parts, Vec3d w) {
    Vec3d sum{};
    for (const DeltaPart& p : parts.parts)
        if (length(p.wi - w) < 1e-4) sum = sum + p.weight * p.q;
    return sum;
}

/// The first delta part that the two do not have alike; "" where there is none. A part that a sampler draws less than
/// once in its draws may not have been met.
std::string differing_delta(const TrialContext& a, const TrialContext& b) {
    const DeltaParts of_a = delta_parts(a, a.first(0)), of_b = delta_parts(b, b.first(0));
    if (of_a.scattered || of_b.scattered) return "";  // no delta parts: what has a density said so
    for (const DeltaParts* parts : {&of_a, &of_b})
        for (const DeltaPart& p : parts->parts) {
            const Vec3d pa = power_towards(of_a, p.wi), pb = power_towards(of_b, p.wi), off = pa - pb;
            const double size = std::max({length(pa), length(pb), 1e-30});
            if (length(off) <= 1e-4 * size) continue;
            return fmt::format(
                "The delta part towards ({:.4g}, {:.4g}, {:.4g}) differs: q times weight is {:.6g} and "
                "{:.6g}.",
                p.wi.x, p.wi.y, p.wi.z, luminance(pa), luminance(pb));
        }
    return "";
}

void tell_f(Verdict& v, const Shared& both, const Difference& d) {
    double sum_a = 0, sum_b = 0;
    for (std::size_t i = 0; i < both.wi.size(); ++i) sum_a += both.a[i], sum_b += both.b[i];
    const Vec3d w = both.wi[d.worst];
    v.evidence["largest_relative"] = d.most;
    v.evidence["worst_wi"] = {w.x, w.y, w.z};
    v.evidence["f"] = {both.a[d.worst], both.b[d.worst]};
    v.say = fmt::format("f differs at {} of {} directions, most at ({:.4g}, {:.4g}, {:.4g}): {:.6g} and {:.6g}",
        d.count, both.wi.size(), w.x, w.y, w.z, both.a[d.worst], both.b[d.worst]);
    v.say += sum_b > 0 ? fmt::format("; on the mean over them f of A is {:.4g} times that of B.", sum_a / sum_b) : ".";
}

}  // namespace

Verdict same_f(const TrialContext& a, const TrialContext& b, bool expect_same) {
    Verdict v = a.verdict("same_f", State::right, "");
    const std::string delta = differing_delta(a, b);
    const bool at_draws = !a.subject.has_f() && a.subject.has_drawn_f();
    if (!(a.subject.has_f() || at_draws) || !b.subject.has_f()) {
        v.state = State::skipped;
        v.say = at_draws                ? "f of A is known at its own draws, and B has none to hold against it."
            : a.subject.draws_at_will() ? "There is no f to compare."
                                        : "The file of A has no column f: there is nothing to compare.";
    } else if (a.scatter().f() || b.scatter().f()) {
        v.state = State::skipped;
        v.say = "f is a random estimate, which is the same in the mean alone: variance compares their means' spread.";
    } else {
        const Shared both = f_of_both(a, b);
        const Difference d = difference(a, b, both);
        v.evidence["same"] = d.count == 0;
        v.evidence["directions"] = both.wi.size();
        v.evidence["differ"] = d.count;
        if (d.count > 0) tell_f(v, both, d);
        else v.say = fmt::format("f is the same at {} directions{}.", both.wi.size(), at_draws ? ", A's draws" : "");
    }
    if (!delta.empty()) {
        v.evidence["same"] = false;
        v.say += " " + delta;
        v.state = State::right;
    }
    if (expect_same && v.evidence.contains("same") && !v.evidence["same"].get<bool>()) v.state = State::wrong;
    return v;
}

}  // namespace crescent::inline against
