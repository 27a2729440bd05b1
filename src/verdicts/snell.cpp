// Where delta parts go: a smooth boundary mirrors, and refracts by the index that is told (Snell); a thin wall lets
// straight through. Where nothing is mirrored, that the boundary lies flat is seen by turning w_o about n. Light goes
// back the way that it came (Helmholtz), whatever the boundary is.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "verdicts/delta.h"
#include "verdicts/ordered.h"

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

}  // namespace

bool refracts_elsewhere(const TrialContext& work, Verdict& v) {
    if (!work.traits.eta) return false;
    const Vec3d wo = work.trial.wo, eta = *work.traits.eta;
    std::vector<Vec3d> across;
    bool mirrored = false;
    for (const DeltaPart& p : delta_parts(work, work.first(0)).parts) {
        const bool through = p.wi.z * wo.z < 0;
        if (!through && !near(p.wi, {-wo.x, -wo.y, wo.z})) return false;  // the boundary lies askew
        mirrored = mirrored || !through;
        const auto known = [&](Vec3d w) { return near(w, p.wi); };
        if (through && std::none_of(across.begin(), across.end(), known)) across.push_back(p.wi);
    }
    const std::size_t indices = eta.x == eta.y && eta.y == eta.z ? 1 : 3;
    if (across.size() > indices) return false;
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

/// Where delta parts of the same kind, mirrored or passed on, send w_i, unless one sends it back to w_o.
std::optional<Vec3d> sent_elsewhere(const TrialContext& work, Vec3d wi) {
    constexpr std::size_t tried = 512, enough = 8;
    const Vec3d wo = work.trial.wo;
    const SampleBatch& b = work.first(0);
    std::vector<Draw> there(std::min(tried, b.u.size()));
    work.subject.sample(0, wi, std::span(b.u).first(there.size()), there);
    std::erase_if(there, [&](const Draw& d) { return !(d.delta > 0) || (d.wi.z * wi.z < 0) != (wi.z * wo.z < 0); });
    const auto back = [&](const Draw& d) { return near(d.wi, wo); };
    if (there.size() < enough || std::ranges::any_of(there, back)) return {};
    return there[0].wi;
}

}  // namespace

bool comes_not_back(const TrialContext& work, Verdict& v) {
    constexpr double grazing = 0.02;
    const DeltaParts deltas = delta_parts(work, work.first(0));
    if (!work.traits.reciprocal || work.traits.wo == Traits::Asked::none || !work.subject.draws_at_will() ||
        deltas.scattered)
        return false;
    for (const DeltaPart& p : deltas.parts) {
        if (p.wi.z < grazing && (work.traits.wo != Traits::Asked::both || p.wi.z > -grazing)) continue;
        const std::optional<Vec3d> there = sent_elsewhere(work, normalize(p.wi));
        if (!there) continue;
        v.state = State::wrong;
        v.evidence["delta_part"] = {p.wi.x, p.wi.y, p.wi.z};
        v.say = fmt::format(
            "A delta part sends w_o to ({:.5g}, {:.5g}, {:.5g}), but that one to ({:.5g}, {:.5g}, {:.5g}) and never "
            "back "
            "to w_o: light does not go back the way that it came.",
            p.wi.x, p.wi.y, p.wi.z, there->x, there->y, there->z);
        return true;
    }
    return false;
}

}  // namespace crescent::inline verdicts
