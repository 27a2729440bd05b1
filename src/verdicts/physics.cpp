// physics: f is reciprocal, reflects no more than it gets, and the white furnace (L = 1) comes out as quadrature says.
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "simd/random.h"
#include "verdicts/ordered.h"

namespace crescent {

namespace {

struct Reciprocity {
    std::size_t tried = 0, broken = 0;
    Pair worst{};
    double one = 0, other = 0;
};

/// Pairs at large, and pairs of w_o with what the sampler draws, where a lobe is high.
std::vector<Pair> pairs_of(const Work& work) {
    std::vector<Pair> pairs;
    const auto direction = [](Vec2<float> u) {
        const double z = 0.02 + 0.98 * static_cast<double>(u.x), sin = std::sqrt(1 - z * z),
                     phi = 2 * pi * static_cast<double>(u.y);
        return Vec3d{sin * math::cos(phi), sin * math::sin(phi), z};
    };
    for (std::uint64_t i = 0; i < 256; ++i)
        pairs.push_back({direction(draw(17, 0, i, 0)), direction(draw(17, 0, i, 1))});
    for (const Draw& d : work.first(0).draws) {
        if (pairs.size() >= 768) break;
        if (d.pdf > 0 && d.wi.z > 0.02) pairs.push_back({work.trial.wo, normalize(d.wi)});
    }
    return pairs;
}

Reciprocity reciprocity(const Work& work) {
    Reciprocity out;
    std::vector<Pair> pairs = pairs_of(work), swapped;
    for (const Pair& p : pairs) swapped.push_back({p.wi, p.wo});
    std::vector<double> a(pairs.size()), b(pairs.size());
    work.subject.f(pairs, a);
    work.subject.f(swapped, b);
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ++out.tried;
        const double off = std::fabs(a[i] - b[i]), size = std::max(std::fabs(a[i]), std::fabs(b[i]));
        if (off <= 1e-4 * size + 1e-30) continue;
        const double loose =
            f_conditioning(work, pairs[i].wo, pairs[i].wi, a[i]) + f_conditioning(work, pairs[i].wi, pairs[i].wo, b[i]);
        if (off <= 1e-4 * size + loose) continue;
        ++out.broken;
        if (off / size <= worst) continue;
        worst = off / size;
        out.worst = pairs[i];
        out.one = a[i];
        out.other = b[i];
    }
    return out;
}

/// More than there is, granted what eta^2 may do to what comes through (transmission.cpp).
bool creates_energy(const Work& work, const Integral& albedo, Verdict& v) {
    constexpr double allowed = 1 + 1e-4;
    const double above = work.whole() ? albedo.bins[0] : albedo.value;
    if (work.whole()) v.evidence["albedo_above"] = above, v.evidence["albedo_below"] = albedo.bins[1];
    if (above - albedo.error > allowed) {
        v.state = State::wrong;
        v.say = fmt::format("The surface reflects {:.6f} of what it gets: f creates energy.", above);
        return true;
    }
    if (!work.whole() || albedo.value - albedo.error <= allowed) return false;
    for (Vec3d b : drawn_below(work)) {
        const Integral through = from_below(work, b);
        v.evidence["from_below"] = through.value;
        if (through.value - through.error <= allowed) continue;
        v.state = State::wrong;
        v.say = fmt::format(
            "The surface gives {:.6f} of an even light from both sides, and light from ({:.4g}, {:.4g}, {:.4g}) below "
            "comes up as {:.6f} of itself: f creates energy, whatever the indices are.",
            albedo.value, b.x, b.y, b.z, through.value);
        return true;
    }
    return false;
}

}  // namespace

Verdict judge_physics(const Work& work) {
    if (!work.subject.has_f()) return work.verdict("physics", State::skipped, "There is no BRDF.");
    Verdict v = work.verdict("physics", State::right, "");
    const Reciprocity r = reciprocity(work);
    v.evidence["reciprocity_pairs"] = r.tried;
    v.evidence["reciprocity_broken"] = r.broken;
    const Integral albedo = work.incoming(Work::Where::everywhere, true);
    v.evidence["albedo"] = albedo.value;
    v.evidence["albedo_error"] = albedo.error;
    if (r.broken > 0) {
        v.state = State::wrong;
        v.say = fmt::format(
            "f is not reciprocal: f(a, b) = {:.6g} but f(b, a) = {:.6g}, with a = ({:.4g}, {:.4g}, {:.4g}), b = "
            "({:.4g}, {:.4g}, {:.4g}), and for {} of {} pairs.",
            r.one, r.other, r.worst.wo.x, r.worst.wo.y, r.worst.wo.z, r.worst.wi.x, r.worst.wi.y, r.worst.wi.z,
            r.broken, r.tried);
        return v;
    }
    if (creates_energy(work, albedo, v)) return v;
    const std::vector<double> x = first_weights(work, true);
    const Spread s = spread(x);
    v.evidence["furnace_mean"] = s.mean;
    v.evidence["furnace_standard_error"] = s.sd / std::sqrt(s.n);
    v.say = fmt::format("f is reciprocal over {} pairs and reflects {:.6f} of an even light", r.tried,
        work.whole() ? albedo.bins[0] : albedo.value);
    if (work.whole())
        v.say += fmt::format(
            ", {:.6f} of one from below (reciprocity across the surface is not looked at: the index is not known)",
            albedo.bins[1]);
    const bool even = work.trial.light.fill > 0;  // an arm that aims at disks alone is not asked for an even light
    if (!even || !mean_is_testable(s, tail_of(x), work.trial.theory)) {
        v.say += even ? fmt::format("; the arm's white furnace reads {:.4g}, with too heavy a tail for a test.", s.mean)
                      : ".";
        return v;
    }
    const Integral reached = work.incoming(Work::Where::reached, true);
    const double p = mean_p(s, reached);
    v.evidence["furnace_expected"] = reached.value;
    v.evidence["furnace_p"] = p;
    v.say += fmt::format(
        "; the arm's white furnace reads {:.6g} where quadrature says {:.6g} (p = {:.3g}).", s.mean, reached.value, p);
    if (has_unmet_tail(work, true)) {
        v.say += " ";
        tell_unmet(v, work.unmet(true), reached, x.size());
        return v;
    }
    if (mean_fails(work, p, reached, true)) {
        v.state = State::wrong;
        v.say = fmt::format("The white furnace reads {:.6g}, quadrature says {:.6g}, and again on a fresh seed.",
            s.mean, reached.value);
    }
    return v;
}

}  // namespace crescent
