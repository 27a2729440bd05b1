// What each lobe draws at a direction: share / |Jacobian| at the u by which that lobe leads there, found by Newton's
// method from the draws of that lobe that fell nearest. Where none is found, and draws of the lobe fell so near that it
// may well lead there, nothing is known of that direction.
#include "diagnosis/lobe_draws.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "simd/scalar.h"
#include "warps/newton.h"

namespace crescent::inline diagnosis {

namespace {

constexpr std::size_t most_of_a_lobe = 192, fewest_at_all = 32, starts = 3;
constexpr std::size_t for_ends = 8000, of_a_point = 11, of_a_way = 40;  // questions
constexpr int newton_steps = 12;
constexpr double grain_of_u = 0x1p-24, margin = 0x1p-7 + 0x1p-12;  // differences fit inside
constexpr double exact = 1e-3, next_to_nothing = 5e-4;             // relative to p

/// How far u may go within a lobe.
struct Room {
    double low[2] = {margin, margin}, high[2] = {1 - margin, 1 - margin};
    Numbers nearest(Numbers u) const {
        for (int k = 0; k < 2; ++k) u[k] = std::round(std::clamp(u[k], low[k], high[k]) / grain_of_u) * grain_of_u;
        return u;
    }
};

Room room_of(const LobeDraws& of, std::size_t lobe) {
    Room out;
    if (of.chooser > 1) return out;
    out.low[of.chooser] = of.lobes[lobe].from + margin;
    out.high[of.chooser] = of.lobes[lobe].to - margin;
    return out;
}

bool is_inside(const Room& room, const Numbers& u) {
    for (int k = 0; k < 2; ++k)
        if (!(u[k] >= room.low[k] && u[k] <= room.high[k])) return false;
    return true;
}

double share_of(const LobeDraws& of, std::size_t lobe) { return of.chooser > 1 ? of.lobes[lobe].share() : 1; }

/// The draws of each lobe by their place in the batch.
std::vector<std::vector<std::size_t>> draws_by_lobe(const LobeDraws& of, const SampleBatch& b) {
    std::vector<std::vector<std::size_t>> out(of.lobes.size());
    for (std::size_t i = 0; i < b.u.size(); ++i)
        if (b.draws[i].pdf > 0) out[lobe_at(of, b.u[i])].push_back(i);
    return out;
}

/// A way from one lobe to a direction that another drew.
struct Search {
    std::size_t of, lobe, place;
    Numbers u;
    bool arrived = false;
};

/// One step of Newton's method for all that have not arrived.
void step(const TrialContext& work, int technique, const LobeDraws& of, std::vector<Search>& all) {
    std::vector<Numbers> from;
    std::vector<Vec3d> to;
    for (const Search& s : all) from.push_back(s.u), to.push_back(of.at[s.of].point.wi);
    const auto moves = newton_moves(work, technique, from, to, {0x1p-12, 0.1, 2 * grain_of_u});
    for (std::size_t i = 0; i < all.size(); ++i) {
        Search& s = all[i];
        s.arrived = moves[i].arrived;
        if (!moves[i].moves) continue;
        s.u.x += moves[i].dx, s.u.y += moves[i].dy;
        for (int k = 0; k < 2; ++k)  // an azimuth goes round
            if (of.chooser != k && (s.u[k] < 0 || s.u[k] >= 1)) s.u[k] -= std::floor(s.u[k]);
        s.u = room_of(of, s.lobe).nearest(s.u);
    }
}

/// The nearest draws of a lobe, and the share of all draws that the lobe may have in 1 sr there, by the last of them.
struct Nearest {
    std::vector<std::size_t> draws;
    double density = 0;
};

Nearest nearest_of(const SampleBatch& b, std::span<const std::size_t> among, Vec3d wi, std::size_t count) {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i : among) {
        const std::pair far{-dot(b.draws[i].wi, wi), i};
        if (near.size() == count && !(far < near.back())) continue;
        near.insert(std::upper_bound(near.begin(), near.end(), far), far);
        if (near.size() > count) near.pop_back();
    }
    Nearest out;
    for (const auto& [far, i] : near) out.draws.push_back(i);
    if (near.empty()) return out;
    const double cap = 2 * pi * std::max(1 + near.back().first, 1e-12);
    out.density = static_cast<double>(near.size()) / (cap * static_cast<double>(b.u.size()));
    return out;
}

/// Points of each lobe, well inside of it, whose Jacobian is known.
void add_points(const TrialContext& work, int technique, std::size_t most, LobeDraws& out,
    std::span<const std::vector<std::size_t>> draws) {
    const SampleBatch& b = work.first(technique);
    for (std::size_t lobe = 0; lobe < out.lobes.size(); ++lobe) {
        const Room room = room_of(out, lobe);
        std::vector<Numbers> u;
        for (std::size_t i : draws[lobe])
            if (is_inside(room, b.u[i]) && u.size() < most) u.push_back(b.u[i]);
        for (const std::optional<WarpPoint>& p : jacobians_at(work, technique, u)) {
            if (!p || !(p->error < exact) || !(p->jacobian > 0)) continue;
            out.at.push_back({*p, lobe, 0, p->error, std::vector<double>(out.lobes.size())});
            out.at.back().drawn[lobe] = share_of(out, lobe) / p->jacobian;
        }
    }
}

/// All that arrive within a few steps.
std::vector<Search> arrivals(const TrialContext& work, int technique, const LobeDraws& of, std::vector<Search> all) {
    std::vector<Search> out;
    for (int k = 0; k < newton_steps && !all.empty(); ++k) {
        step(work, technique, of, all);
        std::copy_if(all.begin(), all.end(), std::back_inserter(out), [](const Search& s) { return s.arrived; });
        std::erase_if(all, [](const Search& s) { return s.arrived; });
    }
    return out;
}

/// A direction is so far from the nearest draw of a lobe, beside how near to that others are, that it lies beyond the
/// lobe's edge.
bool is_beyond(const SampleBatch& b, std::span<const std::size_t> lobe, std::size_t nearest, Vec3d wi) {
    constexpr double by_far = 3;
    constexpr std::size_t about = 8;  // draws, itself among them: so many are not near one another by chance
    const Nearest near = nearest_of(b, lobe, b.draws[nearest].wi, about);
    const double apart = length(b.draws[near.draws.back()].wi - b.draws[nearest].wi);
    return near.draws.size() == about && length(wi - b.draws[nearest].wi) > by_far * apart;
}

/// What the other lobes draw at every point; those where that is not known are left out.
void add_others(
    const TrialContext& work, int technique, LobeDraws& out, std::span<const std::vector<std::size_t>> draws) {
    struct Open {
        std::size_t of, lobe;
        std::vector<std::size_t> from;  // draws
        bool settled = false;
    };
    const SampleBatch& b = work.first(technique);
    std::vector<Open> open;
    for (std::size_t k = 0; k < out.at.size(); ++k)
        for (std::size_t lobe = 0; lobe < out.lobes.size(); ++lobe) {
            if (lobe == out.at[k].own) continue;
            const Nearest near = nearest_of(b, draws[lobe], out.at[k].point.wi, starts);
            const double p = std::min(out.at[k].pdf, out.at[k].drawn[out.at[k].own]);
            if (near.density > next_to_nothing * p) open.push_back({k, lobe, near.draws});
        }
    for (std::size_t start = 0; start < starts; ++start) {
        std::vector<Search> all;
        for (std::size_t k = 0; k < open.size(); ++k)
            if (const Open& o = open[k]; !o.settled && start < o.from.size())
                all.push_back({o.of, o.lobe, k, room_of(out, o.lobe).nearest(b.u[o.from[start]])});
        const std::vector<Search> found = arrivals(work, technique, out, std::move(all));
        std::vector<Numbers> u;
        for (const Search& s : found) u.push_back(s.u);
        const std::vector<std::optional<WarpPoint>> jacobian = jacobians_at(work, technique, u);
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (!jacobian[i] || !(jacobian[i]->error < exact)) continue;
            LobeDraws::At& at = out.at[found[i].of];
            at.drawn[found[i].lobe] = share_of(out, found[i].lobe) / jacobian[i]->jacobian;
            at.error = std::max(at.error, jacobian[i]->error);
            open[found[i].place].settled = true;
        }
    }
    std::vector<char> unknown(out.at.size());
    for (const Open& o : open)
        unknown[o.of] = unknown[o.of] || !(o.settled || is_beyond(b, draws[o.lobe], o.from[0], out.at[o.of].point.wi));
    std::vector<LobeDraws::At> known;
    for (std::size_t k = 0; k < out.at.size(); ++k)
        if (!unknown[k]) known.push_back(std::move(out.at[k]));
    out.at = std::move(known);
}

}  // namespace

std::optional<LobeDraws> lobe_draws_of(const TrialContext& work, int technique) {
    // Nothing is asked after a diagnosis: what is left may go into it.
    const auto left = [&] { return work.subject.limited() ? work.left() : std::size_t{1} << 20; };
    if (left() < 2 * for_ends) return {};
    std::optional<LobeDraws> out = lobes_of(work, technique);
    if (!out) return {};
    const std::size_t n = out->lobes.size(), each = n * (of_a_point + of_a_way * (n - 1));
    const std::size_t most = std::min(most_of_a_lobe, left() / each);
    const std::vector<std::vector<std::size_t>> draws = draws_by_lobe(*out, work.first(technique));
    add_points(work, technique, most, *out, draws);
    std::vector<Vec3d> wi;
    for (const LobeDraws::At& at : out->at) wi.push_back(at.point.wi);
    const std::vector<double> p = work.pdf(technique, wi);
    for (std::size_t k = 0; k < p.size(); ++k) out->at[k].pdf = p[k];
    std::erase_if(out->at, [](const LobeDraws::At& at) { return !(at.pdf > 0) || !std::isfinite(at.pdf); });
    add_others(work, technique, *out, draws);
    if (out->at.size() < fewest_at_all) return {};
    return out;
}

}  // namespace crescent::inline diagnosis
