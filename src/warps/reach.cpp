// Whether draws reach wherever p is positive, for a warp of two numbers that leads to each direction once. p |Jacobian|
// knows the integral of p over what is drawn, and nothing of the rest: so directions are taken at random in proportion
// to p, by what the cubature says of bins and by p itself within them (sampling, importance resampling; Rubin 1988,
// "Using the SIR algorithm to simulate posterior distributions"), and the u of each is looked for by Newton's method
// from the draws that fell nearest. A share s of p that no draw reaches is missed by n of them with (1 - s)^n.
#include "warps/reach.h"

#include <algorithm>
#include <cmath>

#include "simd/random.h"
#include "subjects/numbers.h"
#include "warps/jacobian.h"
#include "warps/newton.h"

namespace crescent::inline warps {

namespace {

constexpr std::size_t candidates = 12000, wanted = 3000, nearest = 10;
constexpr double last_u = 1 - 0x1p-24;

/// A direction to be reached, and the draws that fell nearest, in order, with minus the cosine to them.
struct Sought {
    Vec3d w{};
    double p = 0;
    std::vector<std::pair<double, std::size_t>> near{};
    Numbers u{};
    bool reached = false;
};

/// Directions all over the sphere, most where the bins say that p is, and what p weighs at each beside that.
std::vector<Sought> proposed(const TrialContext& work, int technique, std::vector<double>& weight) {
    const Density& d = work.density(technique);
    const std::size_t sectors = static_cast<std::size_t>(d.sectors), bins = d.mass.bins.size();
    std::vector<double> chance(bins), area(bins);
    double all = 0;
    for (double v : d.mass.bins) all += std::max(v, 0.0);
    for (std::size_t k = 0; k < bins; ++k) {
        area[k] = (d.rings[k / sectors + 1] - d.rings[k / sectors]) / d.sectors;
        chance[k] = 0.8 * std::max(d.mass.bins[k], 0.0) / all + 0.1 * area[k];  // the areas sum to 2
    }
    std::vector<Sought> out;
    std::vector<Vec3d> w;
    double sum = 0;
    std::size_t k = 0;
    for (std::size_t i = 0; i < candidates; ++i) {
        const Numbers u = drawn_numbers(seed_of(work.settings.seed, 0x2eacu), 0, i, 0, 3);
        const double place = (static_cast<double>(i) + u.x) / candidates;
        while (k + 1 < bins && sum + chance[k] < place) sum += chance[k++];
        const std::size_t ring = k / sectors;
        w.push_back(d.map.direction({d.rings[ring] + u.y * (d.rings[ring + 1] - d.rings[ring]),
            (static_cast<double>(k % sectors) + u[2]) / d.sectors}));
        weight.push_back(area[k] / chance[k]);
    }
    const std::vector<double> p = work.pdf(technique, w, true);
    for (std::size_t i = 0; i < candidates; ++i) {
        weight[i] *= p[i];
        out.push_back({w[i], p[i]});
    }
    return out;
}

/// Of these as many as are wanted, each as often as its weight says; `worth`: as how many independent ones they count.
std::vector<Sought> resampled(const std::vector<Sought>& from, std::span<const double> weight, double& worth) {
    double all = 0, squares = 0;
    for (double v : weight) all += v, squares += sqr(v);
    std::vector<Sought> out;
    worth = squares > 0 ? std::min(sqr(all) / squares, static_cast<double>(wanted)) : 0;
    if (!(worth > 0) || !std::isfinite(all)) return out;
    double sum = 0;
    for (std::size_t i = 0, next = 0; i < from.size(); ++i) {
        sum += weight[i] / all * wanted;
        for (; static_cast<double>(next) + 0.5 < sum; ++next) out.push_back(from[i]);
    }
    return out;
}

void find_nearest(const TrialContext& work, const SampleBatch& b, std::vector<Sought>& all) {
    for (Sought& s : all) {
        work.subject.make_way(b.draws.size() / 8);
        for (std::size_t i = 0; i < b.draws.size(); ++i) {
            if (!(b.draws[i].pdf > 0)) continue;
            const std::pair far{-dot(b.draws[i].wi, s.w), i};
            if (s.near.size() == nearest && !(far < s.near.back())) continue;
            s.near.insert(std::upper_bound(s.near.begin(), s.near.end(), far), far);
            if (s.near.size() > nearest) s.near.pop_back();
        }
    }
}

/// One step of Newton's method for each of these; those that are there need no other.
void step(const TrialContext& work, int technique, std::span<Sought* const> open) {
    std::vector<Numbers> from;
    std::vector<Vec3d> to;
    for (const Sought* s : open) from.push_back(s->u), to.push_back(s->w);
    const auto moves = newton_moves(work, technique, from, to, {0x1p-15, 0x1p-5, 0x1p-22});
    const auto on_grid = [](double v) { return std::round(std::clamp(v, 0.0, last_u) * 0x1p24) * 0x1p-24; };
    for (std::size_t i = 0; i < open.size(); ++i) {
        Sought& s = *open[i];
        s.reached = moves[i].arrived;
        if (!moves[i].moves) continue;
        s.u.x = on_grid(s.u.x + moves[i].dx), s.u.y = on_grid(s.u.y + moves[i].dy);
    }
}

/// From the nearest draw first; whoever does not arrive starts again from the next.
void seek(const TrialContext& work, int technique, const SampleBatch& b, std::vector<Sought>& all) {
    constexpr int steps = 7;
    std::size_t left = 33000;  // questions; with the candidates a part of what is kept aside for the warp
    for (std::size_t from = 0; from < nearest; ++from) {
        std::vector<Sought*> open;
        for (Sought& s : all)
            if (!s.reached && from < s.near.size()) s.u = b.u[s.near[from].second], open.push_back(&s);
        for (int k = 0; k < steps && !open.empty(); ++k) {
            if (work.subject.limited() && left < 3 * open.size()) return;
            left -= std::min(left, 3 * open.size());
            step(work, technique, open);
            std::erase_if(open, [](const Sought* s) { return s->reached; });
        }
    }
}

}  // namespace

Reach reach_of_draws(const TrialContext& work, int technique) {
    Reach out;
    if (work.traits.numbers != 2 || work.traits.own_random || work.scatter().any() || !work.subject.draws_at_will())
        return out;
    if (!(work.density(technique).mass.value > 0)) return out;
    std::vector<double> weight;
    const std::vector<Sought> from = proposed(work, technique, weight);
    double worth = 0;
    std::vector<Sought> sought = resampled(from, weight, worth);
    const SampleBatch& b = work.first(technique);
    find_nearest(work, b, sought);
    seek(work, technique, b, sought);
    out.looked_at = sought.size();
    constexpr double crowd = 16;  // of so many draws that are due there, none falls with e^-16
    for (const Sought& s : sought) {
        if (s.reached) continue;
        const double a = s.near.empty() ? 2 : 1 + s.near[0].first;  // 1 - cos to the nearest draw
        const double due = static_cast<double>(b.draws.size()) * s.p * 2 * pi * a;
        ++(due > crowd ? out.empty : out.unknown);
    }
    constexpr double seldom = 6.9;  // -ln 0.001
    if (worth > 0)
        out.share =
            (static_cast<double>(out.unknown + out.empty) / static_cast<double>(out.looked_at)) + seldom / worth;
    return out;
}

}  // namespace crescent::inline warps
