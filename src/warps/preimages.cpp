// Directions that several lobes reach: what they draw there together is the sum of share / |Jacobian| over every u that
// leads there, and p is no less. p |Jacobian| of one lobe alone is more than 1 there whatever it was chosen with. The
// other u are found by Newton's method from the draws that fell nearest.
#include "warps/preimages.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "trials/conditioning.h"
#include "trials/trial_context.h"
#include "warps/branches.h"
#include "warps/jacobian.h"
#include "warps/newton.h"

namespace crescent::inline warps {

namespace {

constexpr std::size_t looked_at_most = 48, starts = 6;
constexpr int newton_steps = 10;
constexpr double grain_of_u = 0x1p-24, rim = 0x1p-6;  // u stays so far inside the square that differences fit
constexpr double apart = 0x1p-8;                      // of two u that are not the same
constexpr double shared = 1.004;                      // p |J| from which on another u must lead there too
constexpr double exact = 1e-3;                        // what |J| must be known to

double on_grid(double u) { return std::round(std::clamp(u, rim, 1 - rim) / grain_of_u) * grain_of_u; }

bool are_apart(const Numbers& a, const Numbers& b) {
    return std::max(std::fabs(a.x - b.x), std::fabs(a.y - b.y)) > apart;
}

/// One try to reach a direction: `of` is its index.
struct Search {
    std::size_t of;
    Numbers u;
    bool arrived = false;
};

/// From the draws that are nearest to each direction and come from elsewhere in the square, or, where a number
/// chooses, from another of its intervals.
std::vector<Search> starts_of(const TrialContext& work, int technique, std::span<const WarpPoint> points, int chooser) {
    const SampleBatch& b = work.first(technique);
    std::vector<Search> all;
    std::vector<Numbers> instead;  // the same with the point's own choice
    const std::size_t most = chooser < 0 ? starts : 3 * starts;
    for (std::size_t k = 0; k < points.size(); ++k) {
        std::vector<std::pair<double, std::size_t>> near;  // the nearest, in order
        for (std::size_t i = 0; i < b.draws.size(); ++i) {
            const std::pair far{-dot(b.draws[i].wi, points[k].wi), i};
            if (near.size() == most && !(far < near.back())) continue;
            const Numbers &u = b.u[i], &own = points[k].u;
            const bool elsewhere = std::max(std::fabs(u.x - own.x), std::fabs(u.y - own.y)) > 16 * apart;
            if (!(b.draws[i].pdf > 0) || (chooser < 0 && !elsewhere)) continue;
            near.insert(std::upper_bound(near.begin(), near.end(), far), far);
            if (near.size() > most) near.pop_back();
        }
        for (const auto& [far, i] : near) {
            all.push_back({k, b.u[i]});
            instead.push_back(all.back().u);
            if (chooser >= 0) instead.back()[chooser] = points[k].u[chooser];
        }
    }
    if (chooser < 0) return all;
    std::vector<Draw> own(instead.size()), other(instead.size());
    std::vector<Numbers> u;
    for (const Search& s : all) u.push_back(s.u);
    work.subject.sample(technique, work.trial.wo, instead, own);
    work.subject.sample(technique, work.trial.wo, u, other);
    std::vector<Search> out;
    std::vector<std::size_t> kept(points.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool one_lobe = length(own[i].wi - other[i].wi) <= 64 * work.direction_resolution() + 1e-9;
        if (!one_lobe && kept[all[i].of]++ < starts) out.push_back(all[i]);
    }
    return out;
}

/// One step of Newton's method for all that have not arrived.
void step(const TrialContext& work, int technique, std::span<const WarpPoint> points, std::vector<Search>& all) {
    std::vector<Numbers> from;
    std::vector<Vec3d> to;
    for (const Search& s : all) from.push_back(s.u), to.push_back(points[s.of].wi);
    const auto moves = newton_moves(work, technique, from, to, {0x1p-12, 0.1, 2 * grain_of_u});
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].arrived = moves[i].arrived;
        if (!moves[i].moves) continue;
        all[i].u.x = on_grid(all[i].u.x + moves[i].dx), all[i].u.y = on_grid(all[i].u.y + moves[i].dy);
    }
}

std::vector<Search> arrivals(
    const TrialContext& work, int technique, std::span<const WarpPoint> points, std::vector<Search> all) {
    std::vector<Search> out;
    for (int k = 0; k < newton_steps && !all.empty(); ++k) {
        step(work, technique, points, all);
        for (const Search& s : all) {
            const bool inside = s.u.x > rim && s.u.x < 1 - rim && s.u.y > rim && s.u.y < 1 - rim;
            const bool again = std::any_of(
                out.begin(), out.end(), [&](const Search& o) { return o.of == s.of && !are_apart(o.u, s.u); });
            if (s.arrived && inside && !again) out.push_back(s);
        }
        std::erase_if(all, [](const Search& s) { return s.arrived; });
    }
    return out;
}

/// Whether a u is none of those that were counted: elsewhere in the square, or in another interval of what chooses.
/// own: where the u goes with the choice of the first of them.
bool is_new(const Numbers& u, std::span<const Numbers> counted, bool own_lobe) {
    for (std::size_t i = 0; i < counted.size(); ++i) {
        if (!are_apart(u, counted[i]) && (i > 0 || own_lobe)) return false;
    }
    return true;
}

/// The u that arrived, with where each goes by its point's own choice, its Jacobian and its share.
struct Arrived {
    std::vector<Search> at;
    std::vector<Draw> by_own_choice;
    std::vector<std::optional<WarpPoint>> jacobian;
    std::vector<double> share;
};

Arrived measured(const TrialContext& work, int technique, std::span<const WarpPoint> points,
    std::vector<Search> searches, int chooser) {
    Arrived out;
    out.at = std::move(searches);
    std::vector<Numbers> u, own;
    for (const Search& s : out.at) {
        u.push_back(s.u), own.push_back(s.u);
        if (chooser >= 0) own.back()[chooser] = points[s.of].u[chooser];
    }
    out.by_own_choice.resize(own.size());
    work.subject.sample(technique, work.trial.wo, own, out.by_own_choice);
    out.jacobian = jacobians_at(work, technique, u);
    out.share.assign(u.size(), 1.0);
    if (chooser >= 0) out.share = follow_branches(work, technique, u).share;
    return out;
}

/// What a u draws at a point, over p, and where it chooses.
struct Part {
    double chooses, over_p;
};
/// All that were found, the point's own first, and what they are known to, relative.
struct Drawn {
    std::vector<Part> parts;
    double error = 0;
    double over_p() const {
        double sum = 0;
        for (const Part& p : parts) sum += p.over_p;
        return sum;
    }
};

Drawn drawn_at(const TrialContext& work, std::size_t k, const WarpPoint& point, const Arrived& all, int chooser) {
    const int by = std::max(chooser, 0);
    Drawn out{{{point.u[by], 1 / point.p_jacobian}}, point.error};
    std::vector<Numbers> counted = {point.u};
    for (std::size_t i = 0; i < all.at.size(); ++i) {
        const std::optional<WarpPoint>& there = all.jacobian[i];
        if (all.at[i].of != k || !there || !(all.share[i] > 0) || there->error > exact) continue;
        const bool own_lobe = length(all.by_own_choice[i].wi - there->wi) <= 64 * work.direction_resolution() + 1e-9;
        if (!is_new(all.at[i].u, counted, own_lobe)) continue;
        counted.push_back(all.at[i].u);
        out.parts.push_back(
            {all.at[i].u[by], all.share[i] / there->p_jacobian});  // p there is p here, to the grain of u
        out.error = std::max(out.error, there->error);
    }
    return out;
}

/// Counts a direction, and whether it is drawn more often than p says.
void add(const TrialContext& work, int technique, const WarpPoint& point, const Drawn& drawn, Reached& out) {
    ++out.looked_at;
    if (drawn.parts.size() == 2) {
        const auto [low, high] = std::minmax(
            drawn.parts[0], drawn.parts[1], [](const Part& a, const Part& b) { return a.chooses < b.chooses; });
        out.pairs.push_back({low.over_p, high.over_p});
    }
    const double allowed = 1e-3 + 3 * drawn.error, over_p = drawn.over_p();
    if (!(over_p > 1 + allowed)) return;
    const double p = point.p_jacobian / point.jacobian;
    if (over_p < 1 + allowed + pdf_conditioning(work, technique, point.wi, p) / p) return;
    ++out.denser;
    if (over_p > out.most) out.most = over_p, out.worst = point.wi;
}

Reached looked_at(const TrialContext& work, int technique) {
    constexpr std::size_t questions = 30000;
    Reached out;
    std::vector<WarpPoint> points;
    for (const WarpPoint& p : study_warp(work, technique).points)
        if (p.p_jacobian > shared && p.error < exact && points.size() < looked_at_most) points.push_back(p);
    if (points.size() < 8 || work.affordable(questions) < questions) return out;
    std::vector<Numbers> u;
    for (const WarpPoint& p : points) u.push_back(p.u);
    const Branches branches = follow_branches(work, technique, u);
    if (branches.choosers > 1) return out;
    out.chooser = std::max(branches.chooser, 0);
    const Arrived all = measured(work, technique, points,
        arrivals(work, technique, points, starts_of(work, technique, points, branches.chooser)), branches.chooser);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Drawn drawn = drawn_at(work, k, points[k], all, branches.chooser);
        if (drawn.parts.size() > 1) add(work, technique, points[k], drawn, out);
    }
    return out;
}

}  // namespace

const Reached& preimages_of(const TrialContext& work, int technique) {
    auto& kept = work.kept.reached[static_cast<std::size_t>(technique)];
    if (!kept) kept = std::make_shared<const Reached>(looked_at(work, technique));
    return *kept;
}

}  // namespace crescent::inline warps
