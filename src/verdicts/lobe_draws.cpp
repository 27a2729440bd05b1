// What each lobe draws at a direction: share / |Jacobian| at the u by which that lobe leads there, found by Newton's
// method from the draws of that lobe that fell nearest. Where none is found, and draws of the lobe fell so near that it
// may well lead there, nothing is known of that direction.
#include "verdicts/lobe_draws.h"

#include <algorithm>
#include <cmath>

#include "simd/scalar.h"

namespace crescent::inline verdicts {

namespace {

constexpr std::size_t points_of_a_lobe = 160, fewest = 32, starts = 3;
constexpr int newton_steps = 12;
constexpr double grain_of_u = 0x1p-24, margin = 0x1p-7 + 0x1p-12;  // differences fit inside
constexpr double exact = 1e-3, next_to_nothing = 5e-4;             // relative to p

/// How far u may go within a lobe.
struct Room {
    double low[2] = {margin, margin}, high[2] = {1 - margin, 1 - margin};
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
    for (std::size_t i = 0; i < b.u.size(); ++i) {
        if (!(b.draws[i].pdf > 0)) continue;
        std::size_t k = 0;
        while (k + 1 < of.lobes.size() && b.u[i][of.chooser] >= of.lobes[k].to) ++k;
        out[k].push_back(i);
    }
    return out;
}

/// A way from one lobe to a direction that another drew.
struct Search {
    std::size_t of, lobe;
    Numbers u;
    bool arrived = false;
};

/// One step of Newton's method for all that have not arrived: the two derivatives by one-sided differences.
void step(const TrialContext& work, int technique, const LobeDraws& of, std::vector<Search>& all) {
    constexpr double h = 0x1p-12;
    std::vector<Numbers> u;
    for (const Search& s : all) {
        u.insert(u.end(), 3, s.u);
        u[u.size() - 2].x += s.u.x < 0.5 ? h : -h, u[u.size() - 1].y += s.u.y < 0.5 ? h : -h;
    }
    std::vector<Draw> w(u.size());
    work.subject.sample(technique, work.trial.wo, u, w);
    for (std::size_t i = 0; i < all.size(); ++i) {
        Search& s = all[i];
        const Vec3d x = (w[3 * i + 1].wi - w[3 * i].wi) * (1 / (u[3 * i + 1].x - s.u.x)),
                    y = (w[3 * i + 2].wi - w[3 * i].wi) * (1 / (u[3 * i + 2].y - s.u.y)),
                    r = of.at[s.of].point.wi - w[3 * i].wi;
        const double xx = dot(x, x), xy = dot(x, y), yy = dot(y, y), det = xx * yy - xy * xy;
        const double due = 2 * grain_of_u * (std::sqrt(xx) + std::sqrt(yy)) + 16 * work.direction_resolution();
        s.arrived = w[3 * i].pdf > 0 && length(r) <= due;
        if (s.arrived || !(det > 1e-12 * xx * yy)) continue;
        const double dx = (yy * dot(x, r) - xy * dot(y, r)) / det, dy = (xx * dot(y, r) - xy * dot(x, r)) / det;
        const double shorter = 0.1 / std::max({0.1, std::fabs(dx), std::fabs(dy)});
        const Room room = room_of(of, s.lobe);
        const auto moved = [&](int k, double by) {
            double to = s.u[k] + shorter * by;
            if (of.chooser != k && (to < 0 || to >= 1)) to -= std::floor(to);  // an azimuth goes round
            return std::round(std::clamp(to, room.low[k], room.high[k]) / grain_of_u) * grain_of_u;
        };
        s.u = [&] {
            Numbers v = s.u;
            v.x = moved(0, dx), v.y = moved(1, dy);
            return v;
        }();
    }
}

/// The share of the draws of a lobe that may fall into 1 sr about a direction: by its third nearest.
struct Nearest {
    std::vector<std::size_t> draws;
    double density = 0;
};

Nearest nearest_of(const SampleBatch& b, std::span<const std::size_t> among, Vec3d wi) {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i : among) {
        const std::pair far{-dot(b.draws[i].wi, wi), i};
        if (near.size() == starts && !(far < near.back())) continue;
        near.insert(std::upper_bound(near.begin(), near.end(), far), far);
        if (near.size() > starts) near.pop_back();
    }
    Nearest out;
    for (const auto& [far, i] : near) out.draws.push_back(i);
    if (near.empty()) return out;
    const double cap = 2 * pi * std::max(1 + near.back().first, 1e-12);
    out.density = static_cast<double>(near.size()) / (cap * static_cast<double>(b.u.size()));
    return out;
}

/// Points of each lobe, well inside of it, whose Jacobian is known.
void add_points(
    const TrialContext& work, int technique, LobeDraws& out, std::span<const std::vector<std::size_t>> draws) {
    const SampleBatch& b = work.first(technique);
    for (std::size_t lobe = 0; lobe < out.lobes.size(); ++lobe) {
        const Room room = room_of(out, lobe);
        std::vector<Numbers> u;
        for (std::size_t i : draws[lobe])
            if (is_inside(room, b.u[i]) && u.size() < points_of_a_lobe) u.push_back(b.u[i]);
        for (const std::optional<WarpPoint>& p : jacobians_at(work, technique, u)) {
            if (!p || !(p->error < exact) || !(p->jacobian > 0)) continue;
            out.at.push_back({*p, lobe, 0, p->error, std::vector<double>(out.lobes.size())});
            out.at.back().drawn[lobe] = share_of(out, lobe) / p->jacobian;
        }
    }
}

std::vector<Search> arrivals(const TrialContext& work, int technique, const LobeDraws& of, std::vector<Search> all) {
    std::vector<Search> out;
    for (int k = 0; k < newton_steps && !all.empty(); ++k) {
        step(work, technique, of, all);
        for (const Search& s : all) {
            const bool again =
                std::any_of(out.begin(), out.end(), [&](const Search& o) { return o.of == s.of && o.lobe == s.lobe; });
            if (s.arrived && !again) out.push_back(s);
        }
        std::erase_if(all, [](const Search& s) { return s.arrived; });
    }
    return out;
}

/// What the other lobes draw at every point; those where that is not known are left out.
void add_others(
    const TrialContext& work, int technique, LobeDraws& out, std::span<const std::vector<std::size_t>> draws) {
    const SampleBatch& b = work.first(technique);
    std::vector<Search> all;
    std::vector<std::vector<char>> open(out.at.size(), std::vector<char>(out.lobes.size()));
    for (std::size_t k = 0; k < out.at.size(); ++k)
        for (std::size_t lobe = 0; lobe < out.lobes.size(); ++lobe) {
            if (lobe == out.at[k].own) continue;
            const Nearest near = nearest_of(b, draws[lobe], out.at[k].point.wi);
            const double p = std::min(out.at[k].pdf, out.at[k].drawn[out.at[k].own]);
            open[k][lobe] = near.density > next_to_nothing * p;
            if (!open[k][lobe]) continue;
            for (std::size_t i : near.draws) {
                const Room room = room_of(out, lobe);
                Numbers u = b.u[i];
                for (int n = 0; n < 2; ++n)
                    u[n] = std::round(std::clamp(u[n], room.low[n], room.high[n]) / grain_of_u) * grain_of_u;
                all.push_back({k, lobe, u});
            }
        }
    const std::vector<Search> found = arrivals(work, technique, out, std::move(all));
    std::vector<Numbers> u;
    for (const Search& s : found) u.push_back(s.u);
    const std::vector<std::optional<WarpPoint>> jacobian = jacobians_at(work, technique, u);
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!jacobian[i] || !(jacobian[i]->error < exact)) continue;
        LobeDraws::At& at = out.at[found[i].of];
        at.drawn[found[i].lobe] = share_of(out, found[i].lobe) / jacobian[i]->jacobian;
        at.error = std::max(at.error, jacobian[i]->error);
        open[found[i].of][found[i].lobe] = 0;
    }
    std::vector<LobeDraws::At> known;
    for (std::size_t k = 0; k < out.at.size(); ++k)
        if (std::none_of(open[k].begin(), open[k].end(), [](char o) { return o; })) known.push_back(out.at[k]);
    out.at = std::move(known);
}

}  // namespace

std::optional<LobeDraws> lobe_draws_of(const TrialContext& work, int technique) {
    constexpr std::size_t questions = 100000;
    if (work.affordable(questions) < questions) return {};
    std::optional<LobeDraws> out = lobes_of(work, technique);
    if (!out) return {};
    const std::vector<std::vector<std::size_t>> draws = draws_by_lobe(*out, work.first(technique));
    add_points(work, technique, *out, draws);
    std::vector<Vec3d> wi;
    for (const LobeDraws::At& at : out->at) wi.push_back(at.point.wi);
    const std::vector<double> p = work.pdf(technique, wi);
    for (std::size_t k = 0; k < p.size(); ++k) out->at[k].pdf = p[k];
    std::erase_if(out->at, [](const LobeDraws::At& at) { return !(at.pdf > 0) || !std::isfinite(at.pdf); });
    add_others(work, technique, *out, draws);
    if (out->at.size() < fewest) return {};
    return out;
}

}  // namespace crescent::inline verdicts
