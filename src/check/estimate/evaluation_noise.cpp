// Compares the first answers with a second round at the same directions, then with neighbours at two distances: the
// differences of a smooth function shrink with the distance, those of an estimate do not.
#include "check/estimate/evaluation_noise.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/constants.h"
#include "check/sources/decorators.h"
#include "math/simd/frame.h"
#include "math/statistics.h"
#include "samplers/domains/sphere_chart.h"

namespace crescent::check {

namespace {

constexpr double fine_step = 0x1p-22, coarse_step = 0x1p-18;  // to a neighbour, radians

/// Relative differences of two rounds of answers where they are not both 0.
std::vector<double> differences(std::span<const double> a, std::span<const double> b) {
    std::vector<double> out;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double size = std::max(std::fabs(a[i]), std::fabs(b[i]));
        if (size > 0 && std::isfinite(size)) out.push_back(std::fabs(a[i] - b[i]) / size);
    }
    return out;
}

/// Whether repeated answers differ at three directions at least and at one of twenty: a single difference is due to
/// state.
double of_repetition(const std::vector<double>& gaps) {
    const auto differ = std::ranges::count_if(gaps, [](double v) { return v > same_number; });
    return differ >= 3 && 20 * differ >= std::ssize(gaps) ? std::max(median_of(gaps), same_number) : 0;
}

/// Neighbours differ if the difference does not shrink with the step: that of a slope is sixteen times smaller at the
/// fine step.
double of_neighbours(const std::vector<double>& near_gaps, const std::vector<double>& far_gaps) {
    constexpr double no_rounding = 0.1;  // larger than the rounding of sharp lobes in single precision
    constexpr std::size_t fewest_values = 16;
    const double small = median_of(near_gaps);
    return near_gaps.size() >= fewest_values && small > no_rounding && median_of(far_gaps) < 4 * small ? small : 0;
}

std::vector<Vec3d> shifted_directions(std::span<const Vec3d> directions, double step) {
    std::vector<Vec3d> out;
    for (Vec3d w : directions) {
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
    if (!source.declaration.can_draw) return out;  // a file has one answer for each direction
    const std::vector<Vec3d> directions = places_of(source, key),
                             near_directions = shifted_directions(directions, fine_step),
                             far_directions = shifted_directions(directions, coarse_step);
    const SamplerAdapter& sampler = uncached(source.adapter);
    const auto answers = [&](const std::vector<Vec3d>& wi, bool is_f) {
        std::vector<Pair> pairs;
        for (Vec3d w : wi) pairs.push_back({source.wo, w});
        std::vector<double> v(wi.size());
        source.count(wi.size());
        is_f ? sampler.f(pairs, v) : sampler.pdf(source.technique, pairs, v);
        return v;
    };
    for (bool is_f : {false, true}) {
        if (is_f ? !source.has_f() : !source.has_density()) continue;
        double& scatter = is_f ? out.f_noise : out.pdf_noise;
        const std::vector<double> first = answers(directions, is_f);
        scatter = of_repetition(differences(first, answers(directions, is_f)));
        if (scatter > 0) continue;
        scatter = of_neighbours(
            differences(first, answers(near_directions, is_f)), differences(first, answers(far_directions, is_f)));
        out.hashed = out.hashed || scatter > 0;
    }
    return out;
}

Sentences sentences_of(const EvaluationNoise& s) {
    if (!s.pdf() && !s.f()) return {};
    const char* what = s.pdf() && s.f() ? "pdf(w) and f(w) are random estimates"
        : s.pdf()                       ? "pdf(w) is a random estimate"
                                        : "f(w) is a random estimate";
    return {{"random estimates",
                fmt::format("{}: {} differ by {:.2g} % (median).", what,
                    s.hashed ? "answers for directions 2e-7 apart" : "two answers for one direction",
                    100 * std::max(s.pdf_noise, s.f_noise))},
        {"tested means", "Their means are tested."}};
}

}  // namespace crescent::check
