// Where delta parts go: a smooth boundary mirrors, and refracts by the index that is told (Snell); a thin wall lets
// straight through. Where nothing is mirrored, that the boundary lies flat is seen by turning w_o about n. Light goes
// back the way that it came (Helmholtz), whatever the boundary is.
#include "verdicts/snell.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <vector>

#include "math/functions.h"
#include "trials/delta.h"
#include "trials/trial_context.h"

namespace crescent::inline verdicts {

namespace {

constexpr double close_to = 1e-3;  // of directions; an index that is told in four digits is that close

bool near(Vec3d a, Vec3d b) { return length(a - b) < close_to; }

/// Where an index refracts w_o to; none where it reflects totally.
std::optional<Vec3d> refracted(Vec3d wo, double below_over_above) {
    const double e = wo.z > 0 ? below_over_above : 1 / below_over_above, x = -wo.x / e, y = -wo.y / e,
                 rest = 1 - x * x - y * y;
    if (rest < 0) return {};
    return Vec3d{x, y, wo.z > 0 ? -std::sqrt(rest) : std::sqrt(rest)};
}

bool is_refracted(Vec3d wo, Vec3d wi, Vec3d eta, bool inverted) {
    for (int c = 0; c < 3; ++c) {
        const double one = channel_of(eta, c);
        const std::optional<Vec3d> due = refracted(wo, inverted ? 1 / one : one);
        if (due && near(*due, wi)) return true;
    }
    return false;
}

double degrees(Vec3d w) { return math::acos(std::min(std::fabs(w.z), 1.0)) * 180 / pi; }

std::string told(Vec3d wo, Vec3d wi, Vec3d eta) {
    const std::optional<Vec3d> due = refracted(wo, eta.x);
    std::string out = fmt::format(
        "A delta part goes through the surface towards ({:.5g}, {:.5g}, {:.5g}), {:.4g} deg from the normal, from w_o "
        "{:.4g} deg from it: the index that is told, {:g}, ",
        wi.x, wi.y, wi.z, degrees(wi), degrees(wo), eta.x);
    if (due)
        out += fmt::format(
            "refracts to ({:.5g}, {:.5g}, {:.5g}), {:.4g} deg from it", due->x, due->y, due->z, degrees(*due));
    else out += "reflects totally there";
    return out + ", and straight through it is not either.";
}

/// A boundary lies flat where it sends a turned w_o to where it sends w_o, turned: one that lies askew does not.
bool turns_with_wo(const TrialContext& work, Vec3d wi) {
    constexpr std::size_t tried = 256;
    constexpr double angle = 2.4;  // no symmetry of a pattern
    const SampleBatch& b = work.first(0);
    if (!work.subject.draws_at_will() || b.u.empty()) return false;
    const auto turned = [c = math::cos(angle), s = math::sin(angle)](
                            Vec3d w) { return Vec3d{c * w.x - s * w.y, s * w.x + c * w.y, w.z}; };
    std::vector<Draw> there(std::min(tried, b.u.size()));
    work.subject.sample(0, turned(work.trial.wo), std::span(b.u).first(there.size()), there);
    return std::any_of(
        there.begin(), there.end(), [due = turned(wi)](const Draw& d) { return d.delta > 0 && near(d.wi, due); });
}

/// A boundary that lies askew refracts by its own normal: one that refracts as a flat one does mirrors as it, too.
bool mirrors_elsewhere(Vec3d wo, Vec3d wi, const std::vector<Vec3d>& across, Vec3d eta, Verdict& v) {
    const auto flat = [&](Vec3d w) { return !near(w, -wo) && is_refracted(wo, w, eta, false); };
    const auto through = std::ranges::find_if(across, flat);
    if (through == across.end()) return false;
    v.state = State::wrong;
    v.evidence["delta_part"] = {wi.x, wi.y, wi.z};
    v.say = fmt::format(
        "A delta part is reflected to ({:.5g}, {:.5g}, {:.5g}), but the boundary that refracts another to ({:.5g}, "
        "{:.5g}, {:.5g}) mirrors w_o to ({:.5g}, {:.5g}, {:.5g}).",
        wi.x, wi.y, wi.z, through->x, through->y, through->z, -wo.x, -wo.y, wo.z);
    return true;
}

}  // namespace

bool refracts_elsewhere(const TrialContext& work, Verdict& v) {
    if (!work.traits.eta) return false;
    const Vec3d wo = work.trial.wo, eta = *work.traits.eta;
    std::vector<Vec3d> across;
    std::optional<Vec3d> askew;  // reflected, but not to the mirror direction of a flat boundary
    bool mirrored = false;
    for (const DeltaPart& p : delta_parts(work, work.first(0)).parts) {
        const bool through = p.wi.z * wo.z < 0;
        if (!through && !near(p.wi, {-wo.x, -wo.y, wo.z})) {
            if (!near(p.wi, wo)) askew = p.wi;
            continue;
        }
        mirrored = mirrored || !through;
        const auto known = [&](Vec3d w) { return near(w, p.wi); };
        if (through && std::none_of(across.begin(), across.end(), known)) across.push_back(p.wi);
    }
    const std::size_t indices = eta.x == eta.y && eta.y == eta.z ? 1 : 3;
    if (across.size() > indices) return false;
    if (askew) return mirrors_elsewhere(wo, *askew, across, eta, v);
    for (Vec3d wi : across) {
        if (near(wi, -wo) || is_refracted(wo, wi, eta, false)) continue;
        if (!mirrored && !turns_with_wo(work, wi)) continue;
        v.state = State::wrong;
        v.say = told(wo, wi, eta);
        v.evidence["delta_part"] = {wi.x, wi.y, wi.z};
        if (is_refracted(wo, wi, eta, true)) {
            v.evidence["diagnosis"] = "1 / eta";
            v.say += " What explains it: 1 / eta for eta.";
        }
        return true;
    }
    return false;
}

namespace {

/// Draws for w_i of delta parts of the same kind: mirrored as w_o is to w_i, or passed on.
std::vector<Draw> sent_from(const TrialContext& work, Vec3d wi) {
    constexpr std::size_t tried = 512;
    const SampleBatch& b = work.first(0);
    std::vector<Draw> out(std::min(tried, b.u.size()));
    work.subject.sample(0, wi, std::span(b.u).first(out.size()), out);
    std::erase_if(
        out, [&](const Draw& d) { return !(d.delta > 0) || (d.wi.z * wi.z < 0) != (wi.z * work.trial.wo.z < 0); });
    return out;
}

/// Weight times q by channel, of the first channel alone where there is one.
Vec3d carried(const TrialContext& work, const Draw& d) {
    const double w = d.weight.value_or(0);
    return d.delta * (work.traits.channels == 3 ? d.weights : Vec3d{w, w, w});
}

bool alike(double a, double b) {
    constexpr double relative = 1e-2;  // Fresnel's T near the critical angle, in single precision
    return std::fabs(a - b) <= relative * std::max(std::fabs(a), std::fabs(b)) + 1e-6;
}
bool alike(Vec3d a, Vec3d b) { return alike(a.x, b.x) && alike(a.y, b.y) && alike(a.z, b.z); }

/// What goes back is to carry, over what comes: f(a, b) / eta_a^2 = f(b, a) / eta_b^2 (Veach 1997, 5.2), and radiance
/// is scaled by 1 / eta^2 either way. None where it is not known.
std::optional<Vec3d> due_back(const TrialContext& work, Vec3d wi) {
    const Vec3d wo = work.trial.wo, mirrored = {-wo.x, -wo.y, wo.z};
    if (wi.z * wo.z > 0) return near(wi, mirrored) ? std::optional(Vec3d{1, 1, 1}) : std::nullopt;
    if (!work.traits.eta || near(wi, -wo) || !is_refracted(wo, wi, *work.traits.eta, false)) return {};
    if (work.traits.importance) return Vec3d{1, 1, 1};
    const auto of = [up = wo.z > 0](double eta) { return sqr(sqr(up ? eta : 1 / eta)); };
    return Vec3d{of(work.traits.eta->x), of(work.traits.eta->y), of(work.traits.eta->z)};
}

/// The part's light and what it carries back differ, where both come in one piece.
bool carries_otherwise_back(
    const TrialContext& work, const DeltaParts& all, const DeltaPart& p, const std::vector<Draw>& back, Verdict& v) {
    const std::optional<Vec3d> due = due_back(work, p.wi);
    const auto in_one_piece = std::ranges::count_if(all.parts, [&](const DeltaPart& o) { return near(o.wi, p.wi); });
    if (!due || in_one_piece != 1 || p.otherwise > 0) return false;
    const Vec3d first = carried(work, back[0]), come = p.q * p.weight,
                expected = {come.x * due->x, come.y * due->y, come.z * due->z};
    if (!std::ranges::all_of(back, [&](const Draw& d) { return alike(carried(work, d), first); })) return false;
    if (alike(first, expected)) return false;
    v.state = State::wrong;
    v.evidence["delta_part"] = {p.wi.x, p.wi.y, p.wi.z};
    v.evidence["carried_back"] = {first.x, first.y, first.z};
    v.evidence["due_back"] = {expected.x, expected.y, expected.z};
    v.say = fmt::format(
        "A delta part carries ({:.4g}, {:.4g}, {:.4g}) of the light from ({:.5g}, {:.5g}, {:.5g}), q times the weight; "
        "the way back carries ({:.4g}, {:.4g}, {:.4g}) where ({:.4g}, {:.4g}, {:.4g}) is due: it is not reciprocal.",
        come.x, come.y, come.z, p.wi.x, p.wi.y, p.wi.z, first.x, first.y, first.z, expected.x, expected.y, expected.z);
    return true;
}

}  // namespace

bool comes_not_back(const TrialContext& work, Verdict& v) {
    constexpr double grazing = 0.02;
    constexpr std::size_t enough = 8;
    const DeltaParts deltas = delta_parts(work, work.first(0));
    if (!work.traits.reciprocal || work.traits.wo == Traits::Asked::none || !work.subject.draws_at_will() ||
        deltas.scattered)
        return false;
    for (const DeltaPart& p : deltas.parts) {
        if (p.wi.z < grazing && (work.traits.wo != Traits::Asked::both || p.wi.z > -grazing)) continue;
        std::vector<Draw> back = sent_from(work, normalize(p.wi));
        const Vec3d there = back.empty() ? Vec3d{} : back[0].wi;
        const bool often = back.size() >= enough;
        std::erase_if(back, [&](const Draw& d) { return !near(d.wi, work.trial.wo); });
        if (!back.empty() && carries_otherwise_back(work, deltas, p, back, v)) return true;
        if (!back.empty() || !often) continue;
        v.state = State::wrong;
        v.evidence["delta_part"] = {p.wi.x, p.wi.y, p.wi.z};
        v.say = fmt::format(
            "A delta part sends w_o to ({:.5g}, {:.5g}, {:.5g}), but that one to ({:.5g}, {:.5g}, {:.5g}) and never "
            "back to w_o: light does not go back the way that it came.",
            p.wi.x, p.wi.y, p.wi.z, there.x, there.y, there.z);
        return true;
    }
    return false;
}

}  // namespace crescent::inline verdicts
