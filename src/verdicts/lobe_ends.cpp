// Where a number jumps from one lobe to the next: the direction is followed along that number at a dozen settings of
// the others, and what is left of a move after 22 halvings is a jump. Ends of lobes stand still while the others move.
#include <algorithm>
#include <cmath>

#include "simd/scalar.h"
#include "verdicts/lobe_draws.h"

namespace crescent::inline verdicts {

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

struct Step {
    std::size_t of;
    double from, to;
    Vec3d a, b;
};

/// Halves each step towards the side that moves more, and drops those that are smooth.
void close_in(const TrialContext& work, int technique, int which, std::span<const Numbers> at, std::vector<Step>& all) {
    for (int k = 0; k < halvings && !all.empty(); ++k) {
        std::vector<Numbers> u;
        for (const Step& s : all) u.push_back(at[s.of]), u.back()[which] = 0.5 * (s.from + s.to);
        const std::vector<Draw> middle = drawn(work, technique, u);
        std::vector<Step> kept;
        for (std::size_t i = 0; i < all.size(); ++i) {
            Step s = all[i];
            if (!(middle[i].pdf > 0)) continue;
            const Vec3d m = middle[i].wi;
            if (length(m - s.a) > length(s.b - m)) s.to = u[i][which], s.b = m;
            else s.from = u[i][which], s.a = m;
            if (length(s.b - s.a) > jump) kept.push_back(s);
        }
        all = std::move(kept);
    }
}

/// The ends within (0, 1) that most settings have in common; none where other jumps are as many.
std::optional<std::vector<double>> common_ends(std::vector<double> all, std::size_t tried) {
    std::sort(all.begin(), all.end());
    std::vector<double> out;
    std::size_t in_common = 0;
    for (std::size_t i = 0, next = 0; i < all.size(); i = next) {
        while (next < all.size() && all[next] - all[i] < one_end) ++next;
        if (3 * (next - i) < tried) continue;
        in_common += next - i;
        out.push_back(all[(i + next) / 2]);
    }
    if (out.empty() || out.size() + 1 > most_lobes || 10 * in_common < 9 * all.size()) return {};
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
            if (w[k].pdf > 0 && w[k + 1].pdf > 0 && length(w[k + 1].wi - w[k].wi) > jump)
                steps.push_back({i, u[k][which], u[k + 1][which], w[k].wi, w[k + 1].wi});
    }
    close_in(work, technique, which, at, steps);
    std::vector<double> all;
    for (const Step& s : steps) all.push_back(0.5 * (s.from + s.to));
    const auto ends = common_ends(std::move(all), at.size());
    if (!ends) return {};
    std::vector<LobeDraws::Lobe> out;
    double from = 0;
    for (double end : *ends) out.push_back({from, end}), from = end;
    out.push_back({from, 1});
    if (which >= 2 && !stays_within(work, technique, which, at, out)) return {};
    return out;
}

}  // namespace

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
    std::vector<double> all(out.lobes.size()), nothing(out.lobes.size());
    for (std::size_t i = 0; i < b.u.size(); ++i) {
        std::size_t k = 0;
        while (k + 1 < out.lobes.size() && b.u[i][out.chooser] >= out.lobes[k].to) ++k;
        ++all[k];
        nothing[k] += is_null_sample(b.draws[i], b.pdf[i]);
    }
    for (std::size_t k = 0; k < all.size(); ++k) out.lobes[k].nothing = nothing[k] / std::max(all[k], 1.0);
    return out;
}

}  // namespace crescent::inline verdicts
