// The same question twice, then at directions 2^-22 and 2^-18 beside: answers that differ, and no less where the step
// is sixteen times smaller, are estimates. The mean over neighbours then stands for pdf(w).
#include "trials/scatter.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "cubature/mesh.h"
#include "math/functions.h"
#include "stats/quantiles.h"
#include "subjects/asked_once.h"
#include "trials/draws.h"

namespace crescent::inline trials {

namespace {

constexpr double same_answer = 1e-4;                // relative: what identity grants two answers
constexpr double fine = 0x1p-22, coarse = 0x1p-18;  // steps to a neighbour

/// Relative differences of two answers, where either is not 0.
std::vector<double> differences(std::span<const double> a, std::span<const double> b) {
    std::vector<double> out;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double size = std::max(std::fabs(a[i]), std::fabs(b[i]));
        if (size > 0 && std::isfinite(size)) out.push_back(std::fabs(a[i] - b[i]) / size);
    }
    return out;
}

/// Answers to one question that differ, at three directions at least and at one of twenty.
double asked_again(const std::vector<double>& apart) {
    const auto differ = std::count_if(apart.begin(), apart.end(), [](double v) { return v > same_answer; });
    return differ >= 3 && 20 * differ >= std::ssize(apart) ? std::max(median_of(apart), same_answer) : 0;
}

/// Of neighbours, where the difference does not shrink with the step: a slope is sixteen times smaller at the fine one.
double of_neighbours(const std::vector<double>& near, const std::vector<double>& far) {
    constexpr double no_rounding = 0.1;  // of sharp lobes in single precision
    constexpr std::size_t enough = 16;
    const double small = median_of(near);
    return near.size() >= enough && small > no_rounding && median_of(far) < 4 * small ? small : 0;
}

std::vector<Vec3d> beside(std::span<const Vec3d> at, double step) {
    std::vector<Vec3d> out;
    for (Vec3d w : at) {
        const Frame<double> frame = frame_about(w);
        out.push_back(normalize(w + frame.t * step + frame.b * (0.7 * step)));
    }
    return out;
}

/// Where the sampler draws, and all over the upper half.
std::vector<Vec3d> directions_of(const Draws& work) {
    std::vector<Vec3d> out;
    for (const Draw& d : work.first(0).draws)
        if (out.size() < 48 && d.pdf > 0 && is_finite(d.wi)) out.push_back(normalize(d.wi));
    for (int i = 0; i < 16; ++i) out.push_back(tilt(5 + 5.2 * i, 137.508 * i));
    return out;
}

}  // namespace

Scatter look_for_scatter(const Draws& work) {
    Scatter out;
    if (!work.subject.draws_at_will()) return out;  // a file has one answer for each direction
    const std::vector<Vec3d> at = directions_of(work), near = beside(at, fine), far = beside(at, coarse);
    const JudgedSampler& subject = afresh(work.subject);
    const auto asked = [&](const std::vector<Vec3d>& wi, bool of_f) {
        std::vector<Pair> pairs;
        for (Vec3d w : wi) pairs.push_back({work.trial.wo, w});
        std::vector<double> v(wi.size());
        of_f ? subject.f(pairs, v) : subject.pdf(0, pairs, v);
        return v;
    };
    for (bool of_f : {false, true}) {
        if (of_f ? !subject.has_f() : !work.traits.has_pdf) continue;
        double& scatter = of_f ? out.of_f : out.of_pdf;
        const std::vector<double> first = asked(at, of_f);
        scatter = asked_again(differences(first, asked(at, of_f)));
        if (scatter > 0) continue;
        scatter = of_neighbours(differences(first, asked(near, of_f)), differences(first, asked(far, of_f)));
        out.hashed = out.hashed || scatter > 0;
    }
    return out;
}

std::string told(const Scatter& s) {
    if (!s.any()) return "";
    const std::string what = s.pdf() && s.f() ? "pdf(w) and f(w) are random estimates"
        : s.pdf()                             ? "pdf(w) is a random estimate"
                                              : "f(w) is a random estimate";
    return fmt::format("{}: {} differ by {:.2g} % (median). What follows is of the mean.", what,
        s.hashed ? "two answers for directions 2e-7 apart" : "two answers for one direction",
        100 * std::max(s.of_pdf, s.of_f));
}

/// A draw under the horizon is not nothing because its pdf(w) came out as 0 once, where others there have one.
void Draws::settle_zeros(SampleBatch& b) const {
    const auto zero = [&](std::size_t i) { return b.draws[i].pdf > 0 && b.draws[i].wi.z <= 0 && b.pdf[i] == 0; };
    bool below = false;
    for (std::size_t i = 0; i < b.draws.size() && !below; ++i)
        below = b.draws[i].pdf > 0 && b.draws[i].wi.z <= 0 && b.pdf[i] > 0;
    for (std::size_t i = 0; below && i < b.draws.size(); ++i)
        if (zero(i)) b.pdf[i] = b.draws[i].pdf;
}

/// Sixteen more answers beside each direction at which f is not 0 and p came out as 0.
void Questions::ask_again_at_zeros(
    std::span<const Vec3d> wi, std::span<const double> value, std::span<double> p) const {
    constexpr int rounds = 16;
    for (int round = 1; round <= rounds; ++round) {
        std::vector<Vec3d> again;
        std::vector<std::size_t> of;
        for (std::size_t i = 0; i < wi.size(); ++i)
            if (p[i] == 0 && value[i] > 0) again.push_back(wi[i]), of.push_back(i);
        if (again.empty() || affordable(again.size()) < again.size()) return;
        const std::vector<double> fresh = any_pdf(beside(again, round * fine));
        for (std::size_t k = 0; k < of.size(); ++k) p[of[k]] = fresh[k];
    }
}

std::vector<double> Questions::mean_pdf(std::span<const Vec3d> wi, int answers) const {
    std::vector<double> sum(wi.size());
    for (int k = 0; k < answers; ++k) {
        const std::vector<double> p = any_pdf(beside(wi, (k + 1) * fine));
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += p[i] / answers;
    }
    return sum;
}

}  // namespace crescent::inline trials
