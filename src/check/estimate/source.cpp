// Passes batches to the sampler as they are; unusable numbers are counted and replaced by 0.
#include "check/estimate/source.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/constants.h"
#include "samplers/domains/sphere_chart.h"
#include "check/sources/check_case.h"
#include "check/sources/decorators.h"
#include "math/simd/frame.h"
#include "math/statistics.h"

namespace crescent::check {

std::span<const Pair> Source::pairs_of(Vec3d from, std::span<const Vec3d> wi) {
    pairs_.resize(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) {
        pairs_[i].wo = from;
        pairs_[i].wi = wi[i];
    }
    evaluations_ += wi.size();
    return pairs_;
}

void Source::note_invalid(InvalidAnswers::Function function, Vec3d wi, double value) {
    ++(function == InvalidAnswers::Function::pdf ? invalid_.pdf : invalid_.f);
    if (invalid_.first != InvalidAnswers::Function::none) return;
    invalid_.first = function;
    invalid_.wi = wi;
    invalid_.value = value;
}

void Source::draw(std::span<const PrimarySample> u, std::span<Draw> out) {
    evaluations_ += u.size();
    adapter.sample(technique, wo, u, out);
}

namespace {

/// The rows, of each eight, that a stream uses.
std::span<const std::uint32_t> rows_for(const StreamKey& key) {
    static constexpr std::uint32_t pilot[] = {0}, first[] = {1, 3, 5, 7}, second[] = {2, 4, 6};
    if (key.purpose == Purpose::pilot) return pilot;
    return key.confirms() ? std::span<const std::uint32_t>(second) : first;
}

}  // namespace

std::uint32_t Source::available(const StreamKey& key, std::uint32_t limit) const {
    if (!recorded_) return limit;
    const std::span<const std::uint32_t> rows = rows_for(key);
    std::size_t count = recorded_->rows() / 8 * rows.size();
    for (std::uint32_t r : rows) count += r < recorded_->rows() % 8;
    return static_cast<std::uint32_t>(std::min<std::size_t>(limit, count));
}

void Source::draw(const StreamKey& key, std::uint32_t from, std::span<PrimarySample> u, std::span<Draw> out) {
    if (!recorded_) {
        for (std::uint32_t i = 0; i < u.size(); ++i) u[i] = numbers_at(key, from + i, numbers(), resolution());
        return draw(u, out);
    }
    const std::span<const std::uint32_t> rows = rows_for(key);
    for (std::uint32_t i = 0; i < u.size(); ++i) {
        const std::size_t k = from + i, row = k / rows.size() * 8 + rows[k % rows.size()];
        u[i] = recorded_->row_numbers(row);
        out[i] = recorded_->row(row);
    }
}

void Source::density(std::span<const Vec3d> wi, std::span<double> out) {
    if (!has_density()) {
        std::fill(out.begin(), out.end(), 1.0);
        return;
    }
    adapter.exact_pdf(technique, pairs_of(wi), out);
    invalid_.pdf_evaluations += wi.size();
    for (std::size_t i = 0; i < wi.size(); ++i) {
        if (std::isfinite(out[i]) && out[i] >= 0) continue;
        note_invalid(InvalidAnswers::Function::pdf, wi[i], out[i]);
        out[i] = 0;
    }
}

double Source::density(Vec3d wi) {
    double p = 0;
    density({&wi, 1}, {&p, 1});
    return p;
}

void Source::density_from(Vec3d other_wo, std::span<const Vec3d> wi, std::span<double> out) {
    if (!has_density()) return std::fill(out.begin(), out.end(), 1.0);
    adapter.exact_pdf(technique, pairs_of(other_wo, wi), out);
}

void evaluate_below(Source& source, std::span<const Vec3d> w, std::span<double> p) {
    std::vector<std::size_t> rows;
    std::vector<Vec3d> directions;
    for (std::size_t k = 0; k < w.size(); ++k)
        if (!(w[k].z > 0)) {
            rows.push_back(k);
            directions.push_back(w[k]);
        }
    std::vector<double> density(rows.size());
    source.density(directions, density);
    for (std::size_t k = 0; k < rows.size(); ++k) p[rows[k]] = density[k];
}

UsableDraws usable_draws(Source& source, std::span<const Draw> draws, Source* lower_source) {
    UsableDraws out;
    for (std::size_t i = 0; i < draws.size(); ++i)
        if (has_direction(draws[i])) {
            out.row.push_back(i);
            out.w.push_back(draws[i].wi);
        }
    out.p.resize(out.w.size());
    if (lower_source) {
        for (std::size_t k = 0; k < out.w.size(); ++k) out.p[k] = draws[out.row[k]].pdf;
        evaluate_below(*lower_source, out.w, out.p);
    } else {
        source.density(out.w, out.p);
    }
    std::size_t count = 0;
    for (std::size_t k = 0; k < out.w.size(); ++k) {
        if (!is_direction(source.traits, draws[out.row[k]], out.p[k])) continue;
        out.row[count] = out.row[k];
        out.w[count] = out.w[k];
        out.p[count++] = out.p[k];
    }
    out.row.resize(count);
    out.w.resize(count);
    out.p.resize(count);
    return out;
}

bool Source::reached_otherwise(Vec3d wi) {
    for (int t = 0; t < adapter.techniques(); ++t) {
        double p = 0;
        if (t != technique) adapter.exact_pdf(t, pairs_of({&wi, 1}), {&p, 1});
        if (p > 0) return true;
    }
    return false;
}

void Source::mis_weights(std::span<const Vec3d> wi, std::span<double> out) {
    adapter.mis_weight(technique, pairs_of(wi), out);
}

void Source::stated_pdf(std::span<const Vec3d> wi, std::span<double> out) {
    if (!has_density()) return std::fill(out.begin(), out.end(), 1.0);
    adapter.pdf(technique, pairs_of(wi), out);
}

void Source::f_cos(std::span<const Vec3d> wi, std::span<Vec3d> out, bool truth) {
    const std::span<const Pair> pairs = pairs_of(wi);
    if (channels() == 3 && !truth) {
        adapter.f_channels(pairs, out);
    } else {
        std::vector<double> y(wi.size());
        truth ? adapter.reference_f(pairs, y) : adapter.f(pairs, y);
        for (std::size_t i = 0; i < y.size(); ++i) out[i] = {y[i], y[i], y[i]};
    }
    invalid_.f_evaluations += wi.size();
    const auto usable = [](double v) { return std::isfinite(v) && v >= 0; };
    for (std::size_t i = 0; i < wi.size(); ++i) {
        const Vec3d v = out[i];
        const double c = traits.cosine(wi[i]);
        if (!usable(v.x) || !usable(v.y) || !usable(v.z))
            note_invalid(InvalidAnswers::Function::f, wi[i], !usable(v.x) ? v.x : !usable(v.y) ? v.y : v.z);
        const auto by_channel = [&](double x) { return usable(x) ? x * c : 0; };
        out[i] = {by_channel(v.x), by_channel(v.y), by_channel(v.z)};
    }
}

// ---- 64 pairs: a function of another kind practically never agrees at all of them by chance.

namespace {

constexpr int pair_count = 64;
constexpr int fewest = 16;  // pairs with f > 0; fewer show nothing

bool nearly_equal(double a, double b) { return std::fabs(a - b) <= reciprocity_tolerance * std::max(a, b); }

}  // namespace

BothWays both_ways(const SamplerAdapter& adapter, StreamKey key) {
    const Traits traits = adapter.traits();
    if (!adapter.has_f() || traits.eta || !traits.has_surface()) return BothWays::not_known;
    const bool is_two_sided = traits.wo == Traits::WoDomain::both;
    Stream stream(key);
    const auto draw_direction = [&](bool is_below) { return random_direction(stream, is_below, 0.02); };
    std::vector<Pair> forward_pairs, reverse_pairs, crossing_pairs;
    for (int i = 0; i < pair_count; ++i) {
        forward_pairs.push_back({draw_direction(is_two_sided && (i & 1)), draw_direction(is_two_sided && !(i & 1))});
        reverse_pairs.push_back({forward_pairs.back().wi, forward_pairs.back().wo});
        crossing_pairs.push_back({draw_direction(false), draw_direction(true)});
    }
    std::vector<double> f(pair_count), g(pair_count), h(pair_count);
    adapter.f(forward_pairs, f);
    adapter.f(reverse_pairs, g);
    adapter.f(crossing_pairs, h);
    const auto is_positive = [](const std::vector<double>& v) {
        return std::ranges::all_of(v, [](double x) { return x > 0; });
    };
    bool is_phase = is_positive(f) && is_positive(g) && is_positive(h), is_symmetric = is_two_sided;
    int positive = 0;
    for (std::size_t i = 0; i < f.size(); ++i) {
        positive += f[i] > 0;
        is_phase =
            is_phase && nearly_equal(f[i] * std::fabs(forward_pairs[i].wi.z), g[i] * std::fabs(forward_pairs[i].wo.z));
        is_symmetric = is_symmetric && nearly_equal(f[i], g[i]);
    }
    if (is_phase) return BothWays::phase_function;
    return is_symmetric && positive >= fewest ? BothWays::same_f : BothWays::not_known;
}

// ---- Finds the next change by increasing moves of one number, then by bisection.

namespace {

constexpr double longest_move = 0x1p-4, side_move = 0x1p-10;
constexpr std::ptrdiff_t draws_to_begin = 64;  // without a step among these draws, no others are tested
// They bisect the last fourfold move: the jump is then known to 1/16 of the distance to it.
constexpr int step_halvings = 6;

class Mover {
    static constexpr double largest_jump = 2;  // larger than any distance of directions

public:
    Mover(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w)
        : source_(source), u_(u), w_(w) {}

    /// The jumps of these draws if number k moves inwards by the given distances.
    std::vector<LocalStep> find_jumps(const std::vector<std::size_t>& rows, int k, const std::vector<double>& moves) {
        std::vector<PrimarySample> v;
        for (std::size_t i : rows) {
            v.push_back(u_[i]);
            v.back()[k] += v.back()[k] < 0.5 ? moves[i] : -moves[i];
        }
        std::vector<Draw> draws(v.size());
        source_.draw(v, draws);
        std::vector<LocalStep> out;
        for (std::size_t j = 0; j < rows.size(); ++j) {
            const Vec3d d = draws[j].wi - w_[rows[j]];
            const bool is_drawn = draws[j].pdf > 0 && draws[j].delta == 0;
            out.push_back({is_drawn ? std::sqrt(dot(d, d)) : largest_jump, draws[j].wi});
        }
        return out;
    }

private:
    Source& source_;
    const std::vector<PrimarySample>& u_;
    const std::vector<Vec3d>& w_;
};

/// The jump at the next change of each draw along number k; 0 if the smallest move already changes it, or none does.
std::vector<LocalStep> jumps_along(Mover& mover, int k, std::size_t count) {
    std::vector<LocalStep> out(count);
    std::vector<double> low(count), high(count, ulp);
    std::vector<std::size_t> open(count), closing;
    for (std::size_t i = 0; i < count; ++i) open[i] = i;
    for (double distance = ulp; distance <= longest_move && !open.empty(); distance *= 4) {
        std::vector<std::size_t> unchanged;
        const std::vector<LocalStep> d = mover.find_jumps(open, k, high);
        for (std::size_t j = 0; j < open.size(); ++j) {
            const std::size_t i = open[j];
            if (d[j].jump == 0) {
                low[i] = distance;
                high[i] = 4 * distance;
                unchanged.push_back(i);
            } else if (distance > ulp) {
                out[i] = d[j];
                closing.push_back(i);
            }
        }
        open = std::move(unchanged);
    }
    std::vector<double> middle(count);
    for (int n = 0; n < step_halvings && !closing.empty(); ++n) {
        for (std::size_t i : closing) middle[i] = (low[i] + high[i]) / 2;
        const std::vector<LocalStep> d = mover.find_jumps(closing, k, middle);
        for (std::size_t j = 0; j < closing.size(); ++j) {
            const std::size_t i = closing[j];
            (d[j].jump == 0 ? low[i] : high[i]) = middle[i];
            if (d[j].jump > 0) out[i] = d[j];
        }
    }
    return out;
}

std::vector<LocalStep> steps_of(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w) {
    std::vector<LocalStep> out(w.size());
    Mover mover(source, u, w);
    for (int k = 0; k < source.numbers(); ++k) {
        const std::vector<LocalStep> steps = jumps_along(mover, k, w.size());
        std::vector<std::size_t> jumping;
        for (std::size_t i = 0; i < w.size(); ++i)
            if (steps[i].jump > 0) jumping.push_back(i);
        std::vector<double> side_movement(w.size());  // largest movement of w by another number, per unit
        for (int j = 0; j < source.numbers() && !jumping.empty(); ++j) {
            if (j == k) continue;
            const std::vector<LocalStep> d = mover.find_jumps(jumping, j, std::vector<double>(w.size(), side_move));
            for (std::size_t n = 0; n < jumping.size(); ++n)
                side_movement[jumping[n]] = std::max(side_movement[jumping[n]], d[n].jump / side_move);
        }
        for (std::size_t i : jumping) {
            const double jump = steps[i].jump, area = jump * std::max(side_movement[i], two_pi / 2 * jump);
            if (jump > out[i].jump && area <= one_direction) out[i] = steps[i];
        }
    }
    return out;
}

}  // namespace

std::vector<LocalStep> local_steps(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w) {
    if (source.traits.own_random || !source.declaration.can_draw) return {};
    const auto first = std::min<std::ptrdiff_t>(draws_to_begin, std::ssize(w));
    const std::vector<LocalStep> first_steps =
        steps_of(source, {u.begin(), u.begin() + first}, {w.begin(), w.begin() + first});
    const bool has_steps = std::ranges::any_of(first_steps, [](const LocalStep& s) { return s.jump > 0; });
    return has_steps ? steps_of(source, u, w) : first_steps;
}

// ---- Compares the first answers with a second round at the same directions, then with neighbours at two distances:
// the differences of a smooth function shrink with the distance, those of an estimate do not.

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
