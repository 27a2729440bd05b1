// |Jacobian| x p without knowing the warp: central differences of sample(wo, u). Where a warp is one to one, p |J| = 1;
// where several u reach one direction p is the sum of 1/|J| over them, so p |J| >= 1 everywhere. p |J| < 1 is a wrong
// density in any case, whatever the sampler. Seams and kinks of a warp (a tabulated density has one at every cell) are
// told from smooth ground by comparing step sizes, and by one-sided differences: beside a kink the side away from it is
// clean.
#include "warps/jacobian.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "stats/quantiles.h"
#include "trials/trial_context.h"
#include "warps/branches.h"
#include "warps/suspects.h"

namespace crescent::inline warps {

namespace {

using namespace differences;

constexpr std::ptrdiff_t most_suspects = 60;  // that are asked about again

struct Derivative {
    double j = 0;      // |d w / d u1 x d w / d u2|
    double error = 0;  // relative
    bool usable = false;
    double along[2] = {};  // |d w / d u|
};

Derivative derivative(std::span<const Draw> w, double direction_resolution) {
    Derivative out;
    for (const Draw& d : w)
        if (!(d.pdf > 0)) return out;
    const Vec3d c = w[0].wi;
    const auto central = [&](int plus, int minus, double h) { return (w[plus].wi - w[minus].wi) * (0.5 / h); };
    const double h = step, k = step / 2;
    const Vec3d x1 = central(1, 2, h), y1 = central(3, 4, h), x2 = central(5, 6, k), y2 = central(7, 8, k);
    const double j1 = area(x1, y1), j2 = area(x2, y2);
    if (!(j2 > 0)) return out;
    out.j = (4 * j2 - j1) / 3;  // Richardson
    const double lx = length(x2), ly = length(y2);
    const double noise = direction_resolution * (1 / lx + 1 / ly) * (lx * ly / j2) / k;
    const auto sided = [&](int px, int py, double s) {
        return area((w[px].wi - c) * (1 / s), (w[py].wi - c) * (1 / s));
    };
    const double wide = std::fabs(sided(1, 3, h) - sided(2, 4, h)), narrow = std::fabs(sided(5, 7, k) - sided(6, 8, k));
    out.error = std::fabs(j2 - j1) / j2 / 3 + noise;
    out.usable =
        out.error < 0.05 && narrow < 0.7 * wide + 4 * noise * j2 + 1e-3 * j2;  // a kink does not halve with the step
    out.along[0] = lx;
    out.along[1] = ly;
    return out;
}

/// Three times the median distance of p |J| from 1 in single precision, where a table's sums are rounded; 0 where p |J|
/// is not 1 in the mean.
double scatter_about_one(const TrialContext& work, std::span<const WarpPoint> points) {
    constexpr double single = 0x1p-24, near = 0.1;
    std::vector<double> off;
    double sum = 0, squares = 0;
    for (const WarpPoint& at : points) {
        const double by = at.p_jacobian - 1;
        if (std::fabs(by) > near) continue;
        off.push_back(std::fabs(by));
        sum += by, squares += sqr(by);
    }
    if (work.direction_resolution() < single || off.size() < 100 || 10 * off.size() < 9 * points.size()) return 0;
    if (std::fabs(sum) > 2.5 * std::sqrt(squares)) return 0;
    return 3 * median_of(std::move(off));
}

/// p |J| that three of four points do not exceed; 1 where these are too few.
double third_quartile(std::vector<double> pj, std::size_t fewest) {
    if (pj.size() < fewest) return 1;
    const std::size_t at = 3 * pj.size() / 4;
    return order_statistic(std::move(pj), at);
}

struct KnownPoint {
    Vec2d u;
    double pj;
};

/// Over all points at which p |J| is known to 3e-4, and over each sixteenth of the square: what single precision hides
/// at one point its neighbours show together.
void look_at_regions(std::span<const KnownPoint> known, WarpFinding& out) {
    constexpr std::size_t side = 4, fewest = 24;
    std::vector<double> all;
    std::array<std::vector<double>, side * side> regions;
    const auto part = [](double u) { return std::min(static_cast<std::size_t>(side * u), side - 1); };
    for (const KnownPoint& at : known) {
        all.push_back(at.pj);
        regions[part(at.u.x) * side + part(at.u.y)].push_back(at.pj);
    }
    out.nowhere_above = third_quartile(std::move(all), 100);
    for (std::size_t k = 0; k < regions.size(); ++k) {
        const double quartile = third_quartile(std::move(regions[k]), fewest);
        if (quartile >= out.region_below) continue;
        out.region_below = quartile;
        out.region = {static_cast<double>(k / side) / side, static_cast<double>(k % side) / side};
    }
}

/// A number may choose at a few points alone: seen from the denser side glass lets little through. Every suspect is
/// asked for its own share; one whose share is not known is let go.
void recall_choosers(const TrialContext& work, int technique, std::vector<Suspect>& suspects) {
    std::vector<Numbers> at;
    for (const Suspect& s : suspects) at.push_back(s.u);
    const Branches branches = follow_branches(work, technique, at);
    for (std::size_t i = 0; i < suspects.size(); ++i) {
        Suspect& s = suspects[i];
        const double share = branches.share[i];
        s.stands = share > 0 && s.p_j / share * s.share < 1 - s.allowed - branches.known_to / std::max(share, 1e-9);
        s.p *= s.share / std::max(share, 1e-9);
        s.p_j *= s.share / std::max(share, 1e-9);
        s.share = share;
    }
    std::erase_if(suspects, [](const Suspect& s) { return !s.stands; });
}

/// u well inside the square, with their stencils.
std::vector<Numbers> stencils_of(const TrialContext& work, const SampleBatch& b, std::size_t wanted) {
    std::vector<Numbers> u;
    for (std::size_t i = 0; i < b.u.size() && u.size() < wanted * stencil; ++i) {
        const Numbers& c = b.u[i];
        if (std::min({c.x, c.y, 1 - c.x, 1 - c.y}) <= 2 * step) continue;
        if (work.traits.numbers > 2 && !(b.draws[i].pdf > 0)) continue;
        for (const Numbers& v : stencil_at(c)) u.push_back(v);
    }
    return u;
}

void count_steps(const TrialContext& work, const Derivative& d, std::span<const Draw> w, WarpFinding& out) {
    for (int axis = 0; axis < 2; ++axis) {
        const double due = d.along[axis] * tiny_step;
        if (due < 24 * work.direction_resolution()) continue;
        ++out.steps_tried;
        if (length(w[9 + static_cast<std::size_t>(axis)].wi - w[0].wi) < 0.2 * due) ++out.stuck;
    }
}

/// Where nothing is known of the slope: a move that leaves the direction as it is to the last bit, though wide ones
/// lead on. Of three numbers one may choose and do nothing else.
void count_stills(const TrialContext& work, std::span<const Draw> w, WarpFinding& out) {
    if (work.traits.numbers != 2 || std::any_of(w.begin(), w.end(), [](const Draw& d) { return !(d.pdf > 0); })) return;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double due = length(w[5 + 2 * axis].wi - w[6 + 2 * axis].wi) / step * tiny_step;
        if (due < 24 * work.direction_resolution()) continue;
        ++out.steps_tried;
        out.stuck += length(w[9 + axis].wi - w[0].wi) == 0;
    }
}

WarpFinding studied(const TrialContext& work, int technique) {
    WarpFinding out;
    if (!work.subject.draws_at_will() || work.traits.own_random || work.scatter().any()) return out;
    const bool several = work.traits.numbers > 2;
    const std::vector<Numbers> u = stencils_of(work, work.first(technique), work.settings.full ? 8192 : 1024);
    std::vector<Draw> w(u.size());
    work.subject.sample(technique, work.trial.wo, u, w);
    std::vector<Derivative> derivatives;
    std::vector<Numbers> centres;
    for (std::size_t i = 0; i + stencil <= w.size(); i += stencil) {
        derivatives.push_back(derivative(std::span(w).subspan(i, stencil), work.direction_resolution()));
        if (derivatives.back().usable) centres.push_back(u[i]);
    }
    const Branches branches = several ? follow_branches(work, technique, centres) : Branches{};
    out.choosers = branches.choosers;
    std::size_t one = 0, next = 0;
    std::vector<Suspect> suspects;
    std::vector<KnownPoint> known;
    for (std::size_t i = 0; i + stencil <= w.size(); i += stencil) {
        const Derivative& d = derivatives[i / stencil];
        if (!d.usable) count_stills(work, std::span(w).subspan(i, stencil), out);
        if (!d.usable) continue;
        const double share = several ? branches.share[next++] : 1;
        count_steps(work, d, std::span(w).subspan(i, stencil), out);
        if (!(share > 0)) continue;
        ++out.usable;
        const double pj = w[i].pdf * d.j / share, allowed = 5e-4 + 2 * d.error + branches.known_to / share;
        out.points.push_back({w[i].wi, d.j / share, d.error, u[i], pj});
        if (pj < 1 - allowed) suspects.push_back({u[i], w[i].pdf / share, pj, share, allowed});
        if (std::fabs(pj - 1) <= allowed) ++one;
        if (allowed < 8e-4) known.push_back({{u[i].x, u[i].y}, pj});
    }
    if (!work.traits.has_pdf) return out;
    look_at_regions(known, out);
    const double scatter = scatter_about_one(work, out.points);
    std::erase_if(suspects, [scatter](const Suspect& s) { return s.lacking() < scatter; });
    if (work.thrifty() && std::ssize(suspects) > most_suspects)
        suspects.erase(suspects.begin() + most_suspects, suspects.end());
    if (several) recall_choosers(work, technique, suspects);
    look_closer(work, technique, suspects);
    for (const Suspect& s : suspects) {
        if (!s.stands) continue;
        ++out.below;
        if (s.p_j >= out.smallest) continue;
        out.smallest = s.p_j;
        out.at = s.u;
    }
    out.one_to_one = out.usable ? static_cast<double>(one) / static_cast<double>(out.usable) : 0;
    return out;
}

}  // namespace

std::vector<std::optional<WarpPoint>> jacobians_at(
    const TrialContext& work, int technique, std::span<const Numbers> at) {
    std::vector<Numbers> u;
    for (const Numbers& c : at)
        for (const Numbers& v : stencil_at(c)) u.push_back(v);
    std::vector<Draw> w(u.size());
    work.subject.sample(technique, work.trial.wo, u, w);
    std::vector<std::optional<WarpPoint>> out(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
        const Derivative d = derivative(std::span(w).subspan(i * stencil, stencil), work.direction_resolution());
        const Draw& there = w[i * stencil];
        if (d.usable) out[i] = WarpPoint{there.wi, d.j, d.error, at[i], there.pdf * d.j};
    }
    return out;
}

const WarpFinding& study_warp(const TrialContext& work, int technique) {
    auto& kept = work.kept.warps[static_cast<std::size_t>(technique)];
    if (!kept) kept = std::make_shared<const WarpFinding>(studied(work, technique));
    return *kept;
}

}  // namespace crescent::inline warps
