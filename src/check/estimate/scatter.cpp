// The first answers are compared with a second round at the same directions, then with neighbours at two distances: a
// smooth function's differences shrink with the distance, those of an estimate do not.
#include "check/estimate/scatter.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/constants.h"
#include "check/estimate/chart.h"
#include "check/sources/wrappers.h"
#include "math/simd/frame.h"
#include "math/statistics.h"

namespace crescent::check {

namespace {

constexpr double fine_step = 0x1p-22, coarse_step = 0x1p-18;  // to a neighbour, radians

/// Relative differences of two rounds of answers, where either is not 0.
std::vector<double> differences(std::span<const double> a, std::span<const double> b) {
    std::vector<double> out;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double size = std::max(std::fabs(a[i]), std::fabs(b[i]));
        if (size > 0 && std::isfinite(size)) out.push_back(std::fabs(a[i] - b[i]) / size);
    }
    return out;
}

/// Answers to one question differ at three directions at least and at one of twenty: one that differs once is a state.
double of_repetition(const std::vector<double>& apart) {
    const auto differ = std::ranges::count_if(apart, [](double v) { return v > same_number; });
    return differ >= 3 && 20 * differ >= std::ssize(apart) ? std::max(median_of(apart), same_number) : 0;
}

/// Neighbours differ where that does not shrink with the step: a slope is sixteen times smaller at the fine one.
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

std::vector<Vec3d> places_of(Source& source, const StreamKey& key) {
    constexpr double golden = 2.399963229728653;  // radians
    std::vector<PrimarySample> u(48);
    std::vector<Draw> draws(u.size());
    source.draw(key, 0, u, draws);
    std::vector<Vec3d> out;
    for (const Draw& d : draws)
        if (d.pdf > 0 && std::isfinite(d.wi.x + d.wi.y + d.wi.z) && dot(d.wi, d.wi) > 0) out.push_back(normalize(d.wi));
    for (int i = 0; i < 32; ++i) out.push_back(from_chart({(i + 0.5) / 16, std::fmod(golden * i, two_pi)}));
    return out;
}

}  // namespace

EvaluationNoise look_for_noise(Source& source, const StreamKey& key) {
    EvaluationNoise out;
    if (!source.adapter.can_draw()) return out;  // a file has one answer for each direction
    const std::vector<Vec3d> at = places_of(source, key), near = beside(at, fine_step), far = beside(at, coarse_step);
    const SamplerAdapter& anew = uncached(source.adapter);
    const auto answers = [&](const std::vector<Vec3d>& wi, bool of_f) {
        std::vector<Pair> pairs;
        for (Vec3d w : wi) pairs.push_back({source.wo, w});
        std::vector<double> v(wi.size());
        source.count(wi.size());
        of_f ? anew.f(pairs, v) : anew.pdf(source.technique, pairs, v);
        return v;
    };
    for (bool of_f : {false, true}) {
        if (of_f ? !source.has_f() : !source.has_density()) continue;
        double& scatter = of_f ? out.of_f : out.of_pdf;
        const std::vector<double> first = answers(at, of_f);
        scatter = of_repetition(differences(first, answers(at, of_f)));
        if (scatter > 0) continue;
        scatter = of_neighbours(differences(first, answers(near, of_f)), differences(first, answers(far, of_f)));
        out.hashed = out.hashed || scatter > 0;
    }
    return out;
}

std::string text_of(const EvaluationNoise& s) {
    if (!s.pdf() && !s.f()) return "";
    const char* what = s.pdf() && s.f() ? "pdf(w) and f(w) are random estimates"
        : s.pdf()                       ? "pdf(w) is a random estimate"
                                        : "f(w) is a random estimate";
    return fmt::format("{}: {} differ by {:.2g} % (median). Their means are tested.", what,
        s.hashed ? "answers for directions 2e-7 apart" : "two answers for one direction",
        100 * std::max(s.of_pdf, s.of_f));
}

}  // namespace crescent::check
