// Which part of a choosing number leads to the same lobe: with the other numbers held, the third is moved over [0, 1),
// and the ends of the interval in which the direction stays are found by bisection. A sampler that chooses lobe l with
// probability P_l has p >= P_l / |J_l| at what it draws from it, and equality where no other lobe reaches.
#include "warps/branches.h"

#include <algorithm>
#include <cmath>

#include "trials/trial_context.h"

namespace crescent::inline warps {

namespace {

constexpr double last_node = 1 - 0x1p-24;

double node(std::size_t i, std::size_t nodes) {
    return std::min(static_cast<double>(i) / static_cast<double>(nodes - 1), last_node);
}

class Chooser {
public:
    Chooser(const TrialContext& work, int technique, int which) : work_(work), technique_(technique), which_(which) {}

    std::vector<Draw> draw(std::vector<Numbers> u) const {
        std::vector<Draw> out(u.size());
        work_.subject.sample(technique_, work_.trial.wo, u, out);
        return out;
    }
    bool same(const Draw& a, const Draw& b) const {
        return b.pdf > 0 && length(a.wi - b.wi) <= 16 * work_.direction_resolution() + 1e-12;
    }
    Numbers moved(Numbers u, double to) const {
        u[which_] = to;
        return u;
    }
    /// The length of the parts of [0, 1) on which the draw stays, one per u.
    std::vector<double> shares(std::span<const Numbers> at, std::span<const Draw> there, std::size_t nodes) const;

private:
    const TrialContext& work_;
    int technique_, which_;
    struct End {
        std::size_t of;
        double inside, outside;
    };
    void close_in(std::span<const Numbers> at, std::span<const Draw> there, std::vector<End>& ends) const {
        for (int k = 0; k < 22 && !ends.empty(); ++k) {
            std::vector<Numbers> u;
            for (const End& e : ends) u.push_back(moved(at[e.of], 0.5 * (e.inside + e.outside)));
            const std::vector<Draw> drawn = draw(u);
            for (std::size_t i = 0; i < ends.size(); ++i)
                (same(there[ends[i].of], drawn[i]) ? ends[i].inside : ends[i].outside) = u[i][which_];
        }
    }
};

std::vector<double> Chooser::shares(std::span<const Numbers> at, std::span<const Draw> there, std::size_t nodes) const {
    std::vector<double> out(at.size());
    std::vector<End> ends;
    for (std::size_t k = 0; k < at.size(); ++k) {
        std::vector<Numbers> u;
        for (std::size_t i = 0; i < nodes; ++i) u.push_back(moved(at[k], node(i, nodes)));
        const std::vector<Draw> drawn = draw(u);
        for (std::size_t i = 0; i + 1 < nodes; ++i) {
            const double from = u[i][which_], to = i + 2 == nodes ? 1 : u[i + 1][which_];
            const bool a = same(there[k], drawn[i]), b = same(there[k], drawn[i + 1]);
            if (a && b) out[k] += to - from;
            else if (a) out[k] -= from, ends.push_back({k, from, to});
            else if (b) out[k] += to, ends.push_back({k, to, from});
        }
    }
    close_in(at, there, ends);
    for (const End& e : ends) out[e.of] += (e.inside < e.outside ? 1 : -1) * 0.5 * (e.inside + e.outside);
    return out;
}

/// The numbers beside the first two that move the direction anywhere among these.
std::vector<int> choosers_of(
    const TrialContext& work, int technique, std::span<const Numbers> at, std::span<const Draw> there) {
    std::vector<int> out;
    for (int k = 2; k < work.traits.numbers; ++k) {
        const Chooser one(work, technique, k);
        bool moves = false;
        for (double to : {0.0, 0.2, 0.45, 0.7, last_node}) {
            std::vector<Numbers> u;
            for (const Numbers& v : at) u.push_back(one.moved(v, to));
            const std::vector<Draw> drawn = one.draw(u);
            for (std::size_t i = 0; i < drawn.size() && !moves; ++i) moves = !one.same(there[i], drawn[i]);
        }
        if (moves) out.push_back(k);
    }
    return out;
}

}  // namespace

Branches follow_branches(const TrialContext& work, int technique, std::span<const Numbers> all) {
    Branches out;
    out.share.assign(all.size(), 0.0);
    const std::span<const Numbers> at = all.first(std::min<std::size_t>(all.size(), work.settings.full ? 512 : 128));
    std::vector<Draw> there(at.size());
    work.subject.sample(technique, work.trial.wo, at, there);
    const std::vector<int> choosers = choosers_of(work, technique, at, there);
    out.choosers = static_cast<int>(choosers.size());
    if (choosers.empty()) std::fill(out.share.begin(), out.share.end(), 1.0);
    if (choosers.size() != 1) return out;
    out.chooser = choosers[0];
    const Chooser chooser(work, technique, choosers[0]);
    // A small move changes nothing but at the end of an interval.
    std::vector<Numbers> beside;
    for (const Numbers& u : at)
        beside.push_back(chooser.moved(u, u[choosers[0]] + (u[choosers[0]] < 0.5 ? 0x1p-16 : -0x1p-16)));
    const std::vector<Draw> moved = chooser.draw(beside);
    const std::vector<double> share = chooser.shares(at, there, work.thrifty() ? 65 : 129);
    for (std::size_t i = 0; i < at.size(); ++i) out.share[i] = chooser.same(there[i], moved[i]) ? share[i] : 0;
    out.known_to = 0x1p-22;
    return out;
}

}  // namespace crescent::inline warps
