// Evaluates in batches: draws, then p at their directions, then f if weights are used, then values that disagree again
// at neighbouring directions.
#include "check/estimate/observations.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "check/constants.h"
#include "check/estimate/integrals.h"
#include "check/estimate/stream.h"
#include "math/simd/frame.h"

namespace crescent::check {

std::array<Vec3d, 8> neighbours(Vec3d w) {
    std::array<Vec3d, 8> out;
    for (int k = 0; k < 8; ++k) {
        const double a = (k < 4 ? 2 : 8) * ulp;
        const Vec3d v{w.x + (k & 1 ? a : -a), w.y + (k & 2 ? a : -a), w.z + ((k ^ k / 2) & 1 ? a : -a)};
        out[static_cast<std::size_t>(k)] = v * (1 / std::sqrt(dot(v, v)));
    }
    return out;
}

std::vector<Vec3d> of_other_lengths(const Source& source, Vec3d w) {
    std::vector<Vec3d> out = {w};
    if (source.traits.domain || source.recorded()) return out;  // points and tables have no length
    for (const double deviation : {-8 * ulp, -2 * ulp, 2 * ulp, 8 * ulp}) out.push_back(w * (1 + deviation));
    return out;
}

// ---- A weight returned by the sampler has precedence over f cos / pdf.

namespace {

double own_weight(const Source& source, const Draw& d, const Vec3d* f_cos) {
    if (d.weight) return *d.weight;
    if (!source.has_density()) return 0;  // the pdf of a draw is then 1 or 0
    if (!f_cos) return d.f.value_or(0) * source.traits.cosine(d.wi) / d.pdf;
    return (source.channels() == 3 ? luminance(*f_cos) : f_cos->x) / d.pdf;
}

}  // namespace

void append_weights(
    Source& source, std::span<const Draw> batch, const DrawnDirections& directions, std::vector<double>& to) {
    const std::size_t first = to.size();
    to.resize(first + batch.size(), 0);
    std::vector<double> mis(directions.wi.size(), 1);
    if (source.adapter.techniques() > 1) source.mis_weights(directions.wi, mis);
    for (std::size_t k = 0; k < directions.rows.size(); ++k) {
        const Draw& d = batch[directions.rows[k]];
        if (!is_direction(source.traits, d, directions.p[k])) continue;
        const double x = own_weight(source, d, directions.f_cos.empty() ? nullptr : &directions.f_cos[k]);
        if (std::isfinite(x)) to[first + directions.rows[k]] = mis[k] * x * source.radiance(d.wi);
    }
    for (std::size_t i = 0; i < batch.size(); ++i)
        if (batch[i].delta > 0 && batch[i].weight && std::isfinite(*batch[i].weight))
            to[first + i] = *batch[i].weight * source.radiance(batch[i].wi);
}

namespace {

/// Largest number of draws compared with neighbours, nine evaluations each. Of more draws only the share is used.
constexpr std::uint64_t most_compared = 1024;

std::uint64_t key_of(Vec3d w) {
    std::uint64_t a, b;
    std::memcpy(&a, &w.x, 8);
    std::memcpy(&b, &w.y, 8);
    std::uint64_t h = a * 0x9e3779b97f4a7c15u ^ (b * 0xbf58476d1ce4e5b9u >> 3) ^ b << 32;
    return (h ^ h >> 31) * 0x94d049bb133111ebu ^ (w.z < 0);
}

class Observer {
public:
    /// integrals: completed by the draws; none for draws that are compared with draws. lower_source: as in
    /// `observe_draws`, or none.
    Observer(Source& source, const Plan& plan, Integrals* integrals, Source* lower_source, Observations& to)
        : source_(source), plan_(plan), integrals_(integrals), lower_source_(lower_source), to_(to) {}

    /// Whether the pdf of every independent draw so far equals pdf(w): then scrambled draws need no evaluation of
    /// pdf(w).
    bool pdf_is_confirmed() const {
        const DrawChecks& c = to_.checks;
        return !lower_source_ && source_.has_density() && !plan_.estimates && to_.independent > 0 &&
            c.pointwise.times + c.zero.times + c.null_below == 0;
    }

    /// Adds independent draws.
    void batch(const StreamKey& key, std::uint32_t from, std::span<PrimarySample> u, bool uses_f) {
        draws_.assign(u.size(), {});
        source_.draw(key, from, u, draws_);
        process(u, -1, uses_f);
    }
    /// Adds draws `first` to `last` of one scrambled set.
    void set(const StreamKey& key, int number, std::uint32_t first, std::uint32_t last) {
        const ScrambledSobol points(key, source_.numbers(), source_.resolution());
        const auto column = static_cast<std::size_t>(number);
        rows_.resize(to_.node_by_set.size());
        for (std::size_t r = 0; r < rows_.size(); ++r) rows_[r] = to_.node_by_set[r][column];
        std::vector<PrimarySample> u;
        for (std::uint32_t from = first; from < last; from += static_cast<std::uint32_t>(u.size())) {
            u.resize(std::min(source_.batch_rows(), last - from));
            points.points(from, u);
            draws_.assign(u.size(), {});
            source_.draw(u, draws_);
            process(u, number, false);
        }
        for (std::size_t r = 0; r < rows_.size(); ++r) to_.node_by_set[r][column] = rows_[r];
    }

private:
    Source& source_;
    const Plan& plan_;
    Integrals* integrals_;
    Source* lower_source_;
    Observations& to_;
    std::vector<Draw> draws_;
    std::vector<Vec3d> w_, f_, true_f_;
    std::vector<std::size_t> indices_;  // indices of the draws of w_
    std::vector<double> p_;
    std::vector<ChartPoint> points_;
    std::vector<std::uint32_t> leaf_;
    std::vector<double> rows_;  // the column of node_by_set of one set

    void process(std::span<const PrimarySample> u, int set, bool uses_f) {
        w_.clear();
        indices_.clear();
        for (std::size_t i = 0; i < u.size(); ++i)
            if (usable(u[i], draws_[i], set)) {
                w_.push_back(draws_[i].wi);
                indices_.push_back(i);
            }
        p_.resize(w_.size());
        if (lower_source_ || (set >= 0 && pdf_is_confirmed())) {
            for (std::size_t k = 0; k < w_.size(); ++k) p_[k] = draws_[indices_[k]].pdf;
            if (lower_source_) evaluate_below(*lower_source_, w_, p_);
        } else {
            source_.density(w_, p_);
            if (source_.estimates) restore_zeros();
            compare_pdf(u);
        }
        points_.resize(w_.size());
        leaf_.resize(w_.size());
        for (std::size_t k = 0; k < w_.size(); ++k) points_[k] = to_chart(w_[k]);
        plan_.tree.find(points_, leaf_);
        if (uses_f) compare_weights(u, set);
        if (uses_f && set < 0)
            append_weights(source_, draws_, {.rows = indices_, .wi = w_, .p = p_, .f_cos = f_}, to_.weights);
        for (std::size_t k = 0; k < w_.size(); ++k) {
            fetch_leaf(k + fetched_before, set);
            if (is_direction(source_.traits, draws_[indices_[k]], p_[k])) add_direction(k, set, u[indices_[k]]);
            else if (set < 0) {
                ++to_.checks.nothing;
                to_.checks.draws_below += source_.traits.has_surface();
            }
        }
    }

    /// The leaves of successive draws are anywhere in memory: each is requested a few draws before it is used.
    static constexpr std::size_t fetched_before = 8;
    void fetch_leaf(std::size_t k, int set) const {
        if (k >= leaf_.size()) return;
        __builtin_prefetch(&plan_.tree.leaves()[leaf_[k]]);
        if (set >= 0) return;
        if (integrals_) __builtin_prefetch(&integrals_->leaves[leaf_[k]].top);
        __builtin_prefetch(&to_.leaves[leaf_[k]]);
    }

    /// Restores draws below the surface whose estimated p happens to be 0, if other draws there have p > 0.
    void restore_zeros() {
        bool has_density_below = false;
        for (std::size_t k = 0; k < w_.size(); ++k)
            has_density_below = has_density_below || (w_[k].z <= 0 && p_[k] > 0);
        for (std::size_t k = 0; has_density_below && k < w_.size(); ++k)
            if (w_[k].z <= 0 && p_[k] == 0) p_[k] = draws_[indices_[k]].pdf;
    }

    /// Whether the draw is a direction of the density with finite numbers; counts the others.
    bool usable(const PrimarySample& u, const Draw& d, int set) {
        DrawChecks& c = to_.checks;
        if (set < 0) ++c.draws;
        if (d.delta != 0) {
            if (set < 0) {
                ++c.deltas;
                take_delta(d);
            }
            const bool is_probability = d.delta > 0 && d.delta <= 1;
            const double squared = dot(d.wi, d.wi);
            if (!is_probability || !d.weight || !std::isfinite(*d.weight) || *d.weight < -negative_weight ||
                !(std::fabs(squared - 1) <= 2 * unit_length))
                c.invalid.add({.u = u, .draw = d, .p = 0, .expected = 0});
            return false;
        }
        const double squared = dot(d.wi, d.wi);
        if (std::isnan(d.pdf) || d.pdf < 0 || std::isinf(d.pdf) || (d.pdf > 0 && !std::isfinite(squared)) ||
            std::isnan(squared)) {
            c.invalid.add({.u = u, .draw = d, .p = 0, .expected = 0});
            if (set < 0) ++c.unusable;
            return false;
        }
        const bool has_finite_weight = !d.weight || std::isfinite(*d.weight + d.weights.x + d.weights.y + d.weights.z);
        if (!(d.pdf > 0)) {
            if (!has_finite_weight) c.invalid.add({.u = u, .draw = d, .p = 0, .expected = 0});
            if (set < 0) ++c.nothing;
            return false;
        }
        const bool has_bad_weight = !has_finite_weight ||
            (d.weight && std::min({*d.weight, d.weights.x, d.weights.y, d.weights.z}) < -negative_weight);
        if (!(std::fabs(squared - 1) <= 2 * unit_length) || has_bad_weight)
            c.invalid.add({.u = u, .draw = d, .p = 0, .expected = 0});
        if (set < 0) c.bad_weights += has_bad_weight;
        return squared > 0;
    }

    void take_delta(const Draw& d) {
        if (d.delta > 0) to_.deltas.add(d, weight_by_channel(d, source_.channels()));
    }

    /// Tests that the pdf of a draw is within the range of p over a few roundings of w, and that p is not 0 at all of
    /// them.
    void compare_pdf(std::span<const PrimarySample> u) {
        if (!source_.has_density() || plan_.estimates) return;
        std::vector<std::size_t> differing;
        for (std::size_t k = 0; k < w_.size(); ++k)
            if (!(std::fabs(p_[k] - draws_[indices_[k]].pdf) <=
                    same_number * p_[k] + 2 * source_.adapter.tabulation_error(w_[k])))
                differing.push_back(k);
        to_.checks.evaluated_draws += w_.size();
        to_.checks.differing_draws += differing.size();
        if (to_.checks.compared_draws >= most_compared) return;
        differing.resize(std::min<std::size_t>(differing.size(), most_compared - to_.checks.compared_draws));
        if (differing.empty()) return;
        to_.checks.compared_draws += differing.size();
        std::vector<Vec3d> neighbour_directions, scaled_directions;
        for (std::size_t k : differing) {
            for (Vec3d v : of_other_lengths(source_, w_[k])) scaled_directions.push_back(v);
            for (Vec3d v : neighbours(w_[k])) neighbour_directions.push_back(v);
        }
        std::vector<double> q(neighbour_directions.size()), stated_p(scaled_directions.size());
        source_.density(neighbour_directions, q);
        source_.stated_pdf(scaled_directions, stated_p);
        for (std::size_t j = 0; j < differing.size(); ++j) {
            const std::size_t k = differing[j];
            const Draw& d = draws_[indices_[k]];
            const auto first = q.begin() + static_cast<std::ptrdiff_t>(8 * j), last = first + 8;
            double low = std::min(*std::min_element(first, last), p_[k]);
            double high = std::max(*std::max_element(first, last), p_[k]);
            const std::size_t lengths = scaled_directions.size() / differing.size();
            for (const double p : std::span(stated_p).subspan(j * lengths, lengths)) {
                if (!std::isfinite(p)) continue;  // an arc cosine, say, of more than 1
                low = std::min(low, p);
                high = std::max(high, p);
            }
            const bool no_surface = !source_.traits.has_surface();
            const bool is_ignored = d.wi.z <= 0 && high == 0 && !no_surface;  // no density there
            to_.checks.null_below += is_ignored;
            if (is_ignored) continue;
            // At an edge beyond which p is 0 the density may have a pole, such as that of a sphere sampled by area.
            const bool is_at_edge = high > 0 && *std::min_element(first, last) == 0;
            if (d.pdf < low * (1 - same_number) || (d.pdf > high * (1 + same_number) && !is_at_edge))
                to_.checks.pointwise.add({.u = u[indices_[k]], .draw = d, .p = p_[k], .expected = 0});
            if (p_[k] > 0) continue;
            if (high == 0) to_.checks.zero.add({.u = u[indices_[k]], .draw = d, .p = 0, .expected = 0});
            else if (d.wi.z > 0 || no_surface) p_[k] = d.pdf;
        }
    }

    /// Weights of the draws: returned by the sampler, else f cos / pdf. Compares both and adds to the mean.
    void compare_weights(std::span<const PrimarySample> u, int set) {
        const bool has_f = source_.has_f(), has_true_f = has_f && source_.declaration.has_true_f;
        f_.assign(w_.size(), {});
        if (has_f) source_.f_cos(w_, f_);
        if (has_true_f) {
            true_f_.assign(w_.size(), {});
            source_.f_cos(w_, true_f_, true);
        }
        if (set < 0) to_.weighted_draws += static_cast<double>(u.size());
        for (std::size_t k = 0; k < w_.size(); ++k) {
            const Draw& d = draws_[indices_[k]];
            if (!is_direction(source_.traits, d, p_[k])) continue;
            if (!has_f && d.f) f_[k] = Vec3d{1, 1, 1} * (*d.f * source_.traits.cosine(d.wi));
            if (!d.weight && (!source_.has_density() || !(has_f || d.f))) {
                ++to_.weightless;
                continue;
            }
            if (has_f) compare_weight(u[indices_[k]], d, k, has_true_f ? true_f_[k] : f_[k], set);
        }
    }

    void compare_weight(const PrimarySample& u, const Draw& d, std::size_t k, Vec3d expected, int set) {
        const Vec3d f = f_[k];
        const bool has_density = source_.has_density();
        // The weight may be an estimate too; its mean is tested.
        const bool is_random = source_.estimates || source_.f_estimates || source_.traits.own_random;
        bool is_wrong = false, is_untrue = false;
        for (int c = 0; c < source_.channels(); ++c) {
            const auto channel = static_cast<std::size_t>(c);
            const double x = channel_of(f, c), weight = x / d.pdf, y = channel_of(expected, c);
            const double w = !d.weight ? weight : source_.channels() == 3 ? channel_of(d.weights, c) : *d.weight;
            is_wrong = is_wrong || (has_density && std::fabs(weight - w) > same_number * std::max(weight, 1e-6) + 1e-9);
            is_untrue = is_untrue || std::fabs(x - y) > same_number * std::max(y, 1e-6);
            if (set >= 0) continue;
            to_.mean[channel].add(w * mean_bridge(y, p_[k], plan_.mean_weight[channel], is_bridged(source_)));
            if (!has_density) to_.weight_leaves[leaf_[k]][channel].add(w);
        }
        ++to_.checks.weights;
        if (is_wrong && !is_random) to_.checks.weight.add({.u = u, .draw = d, .p = p_[k], .expected = f.x / d.pdf});
        if (is_untrue && !source_.f_estimates)
            to_.checks.reference_f.add({.u = u, .draw = d, .p = f.x, .expected = expected.x});
    }

    /// If rounding leaves few directions, a direction may lie on a cut: the draws are spread over half a step about it.
    std::size_t leaf_of(std::size_t k, const PrimarySample& u) const {
        const double step = plan_.tree.leaves()[leaf_[k]].step;
        if (step <= plan_.step) return leaf_[k];
        const auto bits = [](double x) { return static_cast<std::uint32_t>(x * 0x1p31); };
        const Vec4u<std::uint32_t> hash = pcg4d(Vec4u<std::uint32_t>{bits(u[0]), bits(u[1]), bits(u[2]), bits(u[3])});
        const double r = step / 2 * std::sqrt(unit_number(hash.x)), angle = two_pi * unit_number(hash.y);
        const Frame<double> frame = frame_about(w_[k]);
        return plan_.tree.find(to_chart(w_[k] + frame.t * (r * math::cos(angle)) + frame.b * (r * math::sin(angle))));
    }

    void add_direction(std::size_t k, int set, const PrimarySample& u) {
        const Vec3d w = w_[k];
        const double p = p_[k];
        const std::size_t l = leaf_of(k, u);
        const Leaf& leaf = plan_.tree.leaves()[l];
        const Values v = plan_.values(leaf, w, p);
        if (set >= 0) {
            for (std::size_t q = 0; q < integrands; ++q) to_.by_set[q][static_cast<std::size_t>(set)] += v[q];
            rows_[static_cast<std::size_t>(leaf.coarse)] += v[bridge];
            return;
        }
        ++to_.checks.directions;
        const bool is_resolved = plan_.resolves(leaf, p);
        to_.unresolved += !is_resolved;
        for (std::size_t q = 0; q < integrands; ++q) to_.sums[q].add(v[q]);
        to_.leaves[l] += v[bridge];
        for (std::size_t axis = 0; axis < chart_axes; ++axis) to_.bands[band_of(points_[k], axis)] += v[bridge];
        ++to_.counts[l];
        const double density = source_.has_density() ? p : leaf.q;
        to_.mean_p += density;
        if (!source_.has_density()) {
            constexpr double ring = two_pi / 72;  // 5 degrees
            const auto index = static_cast<std::size_t>(math::acos(std::clamp(w.z, -1.0, 1.0)) / ring);
            ++to_.rings[std::min(index, to_.rings.size() - 1)];
        }
        if (p > 0) {
            const double log_p = v[bridge] > 0 ? v[slope] / v[bridge] : 0;
            to_.log_p.add(log_p);
            to_.slope_log_p += v[slope] * log_p;
        }
        to_.direction_keys.push_back({key_of(w), density});
        if (!integrals_) return;
        LeafIntegral& integral = integrals_->leaves[l];
        if (p > alike * integral.top) complete(integral, points_[k], v, p, is_resolved);
    }

    /// The variance of C for random points is k integral of g^2 = k E[g^2 / p]. The integral of p is that where it is
    /// resolved.
    void complete(LeafIntegral& leaf, ChartPoint point, const Values& v, double p, bool is_resolved) {
        if (to_.excess_draws++ < batch_size) to_.excess_points.push_back({point, p});
        const double draws = to_.independent;
        const auto add = [&](Estimate& e, double h) {
            const double x = leaf.per_point * p * h * h / draws;
            e.variance += x;
            e.doubt += x * x;
        };
        leaf.second += v[bridge] * v[bridge] / draws;
        add(leaf.bridge, v[bridge]);
        for (std::size_t q = 0; q < integrands; ++q)
            add(q == mass && !is_resolved ? integrals_->unresolved : integrals_->sums[q], v[q]);
    }
};

void observe(Source& source, const Plan& plan, const Look& target, std::uint32_t f_draws, const StreamKey& key,
    Integrals* integrals, Source* lower_source, Observations& to) {
    if (to.leaves.empty()) {
        to.leaves.resize(plan.tree.leaves().size());
        to.counts.resize(plan.tree.leaves().size());
        to.node_by_set.resize(plan.tree.rows());
        if (!source.has_density()) to.weight_leaves.resize(plan.tree.leaves().size());
    }
    Observer observer(source, plan, integrals, lower_source, to);
    const bool has_weights = source.has_f() || source.declaration.has_drawn_f;
    std::vector<PrimarySample> u;
    StreamKey draws = key;
    draws.purpose = Purpose::draws;
    const auto first_draw = static_cast<std::uint32_t>(to.independent);
    const std::uint32_t last_draw = source.available(draws, target.independent);
    to.independent = std::max(last_draw, first_draw);
    to.direction_keys.reserve(last_draw);
    for (std::uint32_t from = first_draw; from < last_draw; from += static_cast<std::uint32_t>(u.size())) {
        const bool uses_f = has_weights && from < f_draws;
        u.resize(std::min(uses_f ? batch_size : source.batch_rows(), last_draw - from));
        observer.batch(draws, from, u, uses_f);
    }
    if (integrals && !to.deltas.empty()) to.delta_power = delta_flux(source, to.deltas.parts(to.independent));
    if (source.traits.own_random || !source.declaration.can_draw) return;
    const std::uint32_t evaluations_per_draw =
        lower_source || observer.pdf_is_confirmed() || !source.has_density() ? 1 : 2;
    const std::uint32_t first = static_cast<std::uint32_t>(to.scrambled) / replicate_sets,
                        last = std::max(first, target.scrambled / replicate_sets / evaluations_per_draw);
    for (int set = 0; set < replicate_sets; ++set) {
        StreamKey scramble = key;
        scramble.purpose = Purpose::scrambles;
        scramble.part = static_cast<std::uint16_t>(set);
        observer.set(scramble, set, first, last);
    }
    to.scrambled = static_cast<double>(last) * replicate_sets;
}

}  // namespace

void observe(Source& source, const Plan& plan, const Look& target, std::uint32_t f_draws, const StreamKey& key,
    Integrals& integrals, Observations& to) {
    observe(source, plan, target, f_draws, key, &integrals, nullptr, to);
}

void observe_draws(Source& source, Source& lower_source, const Plan& plan, const Look& target, std::uint32_t f_draws,
    const StreamKey& key, Observations& to) {
    observe(source, plan, target, f_draws, key, nullptr, &lower_source, to);
}

void add_technique(const Observations& technique, Observations& to) {
    const auto add = [](auto& sums, const auto& terms) {
        for (std::size_t i = 0; i < terms.size(); ++i) sums[i] += terms[i];
    };
    to.leaves.resize(technique.leaves.size());
    to.counts.resize(technique.counts.size());
    to.node_by_set.resize(technique.node_by_set.size());
    to.weights.resize(std::max(to.weights.size(), technique.weights.size()));
    to.independent += technique.independent;
    to.scrambled += technique.scrambled;
    for (std::size_t q = 0; q < integrands; ++q) {
        to.sums[q].sum += technique.sums[q].sum;
        to.sums[q].square += technique.sums[q].square;
        add(to.by_set[q], technique.by_set[q]);
    }
    add(to.leaves, technique.leaves);
    add(to.counts, technique.counts);
    add(to.bands, technique.bands);
    add(to.weights, technique.weights);
    for (std::size_t row = 0; row < technique.node_by_set.size(); ++row)
        add(to.node_by_set[row], technique.node_by_set[row]);
    to.checks.unusable += technique.checks.unusable;
    to.weightless += technique.weightless;
}

// ---- Delta parts: directions, q and weights are compared to single precision.

namespace {

bool same_value(double a, double b) { return std::fabs(a - b) <= same_number * std::max(std::fabs(a), std::fabs(b)); }
bool same_weight(Vec3d a, Vec3d b) { return same_value(a.x, b.x) && same_value(a.y, b.y) && same_value(a.z, b.z); }

/// Returns false if there are too many.
bool add_to(std::vector<DeltaPart>& parts, const Draw& d, Vec3d weight, bool compares_weight) {
    const auto part = std::ranges::find_if(parts, [&](const DeltaPart& p) {
        return length(p.wi - d.wi) < same_number && same_value(p.q, d.delta) &&
            (!compares_weight || same_weight(p.weight, weight));
    });
    if (part != parts.end()) {
        ++part->draws;
        part->other_weights += !same_weight(part->weight, weight);
        return true;
    }
    if (parts.size() >= most_delta_parts) return false;
    parts.push_back({d.wi, d.delta, weight, 1, 0});
    return true;
}

/// Whether each part is drawn as often as its q, within six standard deviations.
bool all_come_by_q(const std::vector<DeltaPart>& parts, double n) {
    return std::ranges::all_of(parts, [n](const DeltaPart& p) {
        return std::fabs(static_cast<double>(p.draws) - n * p.q) <= 6 * std::sqrt(n * p.q * (1 - p.q)) + 2;
    });
}

}  // namespace

void DeltaParts::add(const Draw& d, Vec3d weight) {
    scattered_ = !add_to(parts_, d, weight, false) || scattered_;
    many_weights_ = many_weights_ || !add_to(parts_by_weight_, d, weight, true);
}

const std::vector<DeltaPart>& DeltaParts::parts(double draws) const {
    const bool has_uniform_weights =
        std::ranges::all_of(parts_, [](const DeltaPart& p) { return p.other_weights == 0; });
    return has_uniform_weights || many_weights_ || !all_come_by_q(parts_by_weight_, draws) ? parts_ : parts_by_weight_;
}

namespace {

constexpr double straight_on = unit_length;  // tolerance of a direction
constexpr double near_normal = 0.01;         // radians; refraction bends less than that there

/// Power of the first delta part that is transmitted straight at an oblique w_o, where refraction would bend it.
Vec3d through_holes(Source& source) {
    constexpr std::uint32_t draw_count = 512;
    Source oblique_source(source.adapter, source.technique, tilt(source.wo.z > 0 ? 30 : 150), source.light);
    const StreamKey key{.seed = 1, .place = 0, .technique = 0, .stage = 1, .purpose = Purpose::light, .part = 1};
    for (const Draw& d : oblique_source.draw(first_numbers(key, draw_count, source.traits))) {
        if (!(d.delta > 0) || !(length(d.wi + oblique_source.wo) < straight_on)) continue;
        return weight_by_channel(d, source.channels()) * d.delta;
    }
    return {};
}

}  // namespace

std::array<double, 3> delta_flux(Source& source, const std::vector<DeltaPart>& parts) {
    std::array<double, 3> out{}, straight_power{};
    const auto channels = static_cast<std::size_t>(source.channels());
    for (const DeltaPart& p : parts)
        for (std::size_t c = 0; c < channels; ++c) {
            const int channel = static_cast<int>(c);
            const double power = p.q * channel_of(p.weight, channel);
            if (length(p.wi + source.wo) < straight_on) straight_power[c] += power;
            else out[c] += power * flux_factor(source, p.wi, channel);
        }
    if (std::ranges::all_of(straight_power, [](double v) { return v == 0; })) return out;
    const bool is_at_normal = math::hypot(source.wo.x, source.wo.y) < near_normal && source.declaration.can_draw;
    const Vec3d hole_powers = is_at_normal ? through_holes(source) : Vec3d{};
    for (std::size_t c = 0; c < channels; ++c) {
        const int channel = static_cast<int>(c);
        const double hole_power = channel_of(hole_powers, channel);
        // A pane transmits other shares at other angles: all of it counts as a hole if half of it is transmitted
        // straight there.
        const double holes = !is_at_normal || hole_power > straight_power[c] / 2 ? straight_power[c] : hole_power;
        out[c] += holes + (straight_power[c] - holes) * flux_factor(source, -source.wo, channel);
    }
    return out;
}

}  // namespace crescent::check
