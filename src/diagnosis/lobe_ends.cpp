// Where a number jumps from one lobe to the next: the direction is followed along that number at a dozen settings of
// the others, and what is left of a move after 22 halvings is a jump. Ends of lobes stand still while the others move.
#include <algorithm>
#include <cmath>

#include "simd/scalar.h"
#include "diagnosis/lobe_draws.h"

namespace crescent::inline diagnosis {

namespace {

constexpr std::size_t settings_tried = 12, nodes = 65, most_lobes = 6;
constexpr int halvings = 22;
constexpr double jump = 0.02;                   // rad: a root or a logarithm moves less over 2^-22
constexpr double one_end = 1e-4, rim = 0x1p-7;  // of the number; what is steep at 0 and at 1 is no jump

std::vector<Draw> drawn(const TrialContext& work, int technique, std::span<const Numbers> u) {
    std::vector<Draw> out(u.size());
    work.subject.sample(technique, work.trial.wo, u, out);
    return out;
}

/// A move of the number, and what is drawn at either end of it; nothing drawn is a place of its own.
struct Step {
    std::size_t of;
    double from, to;
    Draw a, b;
    bool jumps() const {
        const bool at_a = a.pdf > 0, at_b = b.pdf > 0;
        return at_a != at_b || (at_a && length(b.wi - a.wi) > jump);
    }
};

double move(const Draw& a, const Draw& b) {
    if ((a.pdf > 0) != (b.pdf > 0)) return 4;  // more than any
    return a.pdf > 0 ? length(b.wi - a.wi) : 0;
}

/// Halves each step towards the side that moves more, and drops those that are smooth.
void close_in(const TrialContext& work, int technique, int which, std::span<const Numbers> at, std::vector<Step>& all) {
    for (int k = 0; k < halvings && !all.empty(); ++k) {
        std::vector<Numbers> u;
        for (const Step& s : all) u.push_back(at[s.of]), u.back()[which] = 0.5 * (s.from + s.to);
        const std::vector<Draw> middle = drawn(work, technique, u);
        for (std::size_t i = 0; i < all.size(); ++i) {
            Step& s = all[i];
            if (move(s.a, middle[i]) > move(middle[i], s.b)) s.to = u[i][which], s.b = middle[i];
            else s.from = u[i][which], s.a = middle[i];
        }
        std::erase_if(all, [](const Step& s) { return !s.jumps(); });
    }
}

/// The ends within (0, 1) that many settings have in common; none where other jumps are as many. Where nothing is drawn
/// from on may move with the other numbers, as a horizon does.
std::optional<std::vector<double>> common_ends(std::vector<Step> all, std::size_t tried) {
    std::sort(all.begin(), all.end(), [](const Step& a, const Step& b) { return a.from < b.from; });
    const auto is_of_two = [](const Step& s) { return s.a.pdf > 0 && s.b.pdf > 0; };
    std::vector<double> out;
    std::ptrdiff_t in_common = 0;
    for (auto next = all.begin(); next != all.end();) {
        const auto first = next;
        while (next != all.end() && next->from - first->from < one_end) ++next;
        if (3 * (next - first) < static_cast<std::ptrdiff_t>(tried)) continue;
        in_common += std::count_if(first, next, is_of_two);
        const Step& middle = first[(next - first) / 2];
        out.push_back(0.5 * (middle.from + middle.to));
    }
    if (out.empty() || out.size() + 1 > most_lobes) return {};
    if (10 * in_common < 9 * std::count_if(all.begin(), all.end(), is_of_two)) return {};
    return out;
}

/// A number beside the first two chooses and does nothing else: within a lobe the direction stays.
bool stays_within(const TrialContext& work, int technique, int which, std::span<const Numbers> at,
    std::span<const LobeDraws::Lobe> lobes) {
    for (const LobeDraws::Lobe& lobe : lobes) {
        std::vector<Numbers> u;
        for (const Numbers& v : at)
            for (double part : {0.25, 0.75}) u.push_back(v), u.back()[which] = lobe.from + part * lobe.share();
        const std::vector<Draw> w = drawn(work, technique, u);
        for (std::size_t i = 0; i < w.size(); i += 2)
            if (w[i].pdf > 0 && w[i + 1].pdf > 0 &&
                length(w[i].wi - w[i + 1].wi) > 16 * work.direction_resolution() + 1e-12)
                return false;
    }
    return true;
}

std::vector<LobeDraws::Lobe> chosen_by(
    const TrialContext& work, int technique, int which, std::span<const Numbers> at) {
    std::vector<Step> steps;
    for (std::size_t i = 0; i < at.size(); ++i) {
        std::vector<Numbers> u(nodes, at[i]);
        for (std::size_t k = 0; k < nodes; ++k)
            u[k][which] = std::clamp(static_cast<double>(k) / (nodes - 1), rim, 1 - rim);
        const std::vector<Draw> w = drawn(work, technique, u);
        for (std::size_t k = 0; k + 1 < nodes; ++k)
            if (const Step s{i, u[k][which], u[k + 1][which], w[k], w[k + 1]}; s.jumps()) steps.push_back(s);
    }
    close_in(work, technique, which, at, steps);
    const auto ends = common_ends(std::move(steps), at.size());
    if (!ends) return {};
    std::vector<LobeDraws::Lobe> out;
    double from = 0;
    for (double end : *ends) out.push_back({from, end}), from = end;
    out.push_back({from, 1});
    if (which >= 2 && !stays_within(work, technique, which, at, out)) return {};
    return out;
}

void count_nothing(const SampleBatch& b, LobeDraws& of) {
    std::vector<double> all(of.lobes.size()), nothing(of.lobes.size());
    for (std::size_t i = 0; i < b.u.size(); ++i) {
        const std::size_t k = lobe_at(of, b.u[i]);
        ++all[k];
        nothing[k] += is_null_sample(b.draws[i], b.pdf[i]);
    }
    for (std::size_t k = 0; k < all.size(); ++k) of.lobes[k].nothing = all[k] > 0 ? nothing[k] / all[k] : 1;
}

/// An interval of which nothing is drawn is the end of the lobe before it, beyond a horizon, or no lobe.
void leave_out_nothing(LobeDraws& of) {
    std::vector<LobeDraws::Lobe> kept;
    for (const LobeDraws::Lobe& lobe : of.lobes) {
        if (lobe.nothing < 1) {
            kept.push_back(lobe);
        } else if (of.chooser < 2 && !kept.empty()) {
            LobeDraws::Lobe& before = kept.back();
            before.nothing = 1 - (1 - before.nothing) * before.share() / (lobe.to - before.from);
            before.to = lobe.to;
        }
    }
    of.lobes = std::move(kept);
}

}  // namespace

std::size_t lobe_at(const LobeDraws& of, const Numbers& u) {
    std::size_t k = 0;
    while (k + 1 < of.lobes.size() && u[of.chooser] >= of.lobes[k].to) ++k;
    return k;
}

std::optional<LobeDraws> lobes_of(const TrialContext& work, int technique) {
    if (!work.subject.draws_at_will() || work.traits.own_random || work.scatter().any()) return {};
    const SampleBatch& b = work.first(technique);
    std::vector<Numbers> at;
    for (std::size_t i = 0; i < b.u.size() && at.size() < settings_tried; ++i) {
        const auto inside = [](double u) { return u > 0.1 && u < 0.9; };
        if (inside(b.u[i].x) && inside(b.u[i].y)) at.push_back(b.u[i]);
    }
    LobeDraws out;
    for (int which = work.traits.numbers - 1; which >= 0; --which) {
        std::vector<LobeDraws::Lobe> lobes = chosen_by(work, technique, which, at);
        if (lobes.empty()) continue;
        if (!out.lobes.empty()) return {};  // two numbers choose
        out.chooser = which;
        out.lobes = std::move(lobes);
    }
    if (out.lobes.empty()) return {};
    count_nothing(b, out);
    leave_out_nothing(out);
    if (out.lobes.size() < 2) return {};
    return out;
}

}  // namespace crescent::inline diagnosis
