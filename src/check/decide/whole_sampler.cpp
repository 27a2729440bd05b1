// Directions exactly on axes, planes and the horizon, and one ulp next to them, as w_o and as w_i: a few calls at each,
// which must return usable numbers.
#include "check/decide/whole_sampler.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/estimate/both_ways.h"
#include "check/estimate/source.h"

namespace crescent::check {

namespace {

constexpr std::size_t most_ordinary = 3;  // w_o at which every special w_i is tested

bool answers_for(const Traits& traits, Vec3d wo) { return traits.wo != Traits::WoDomain::upper || wo.z > 0; }

/// Some u at each special w_o: the centre, and others spread over the cube.
std::vector<PrimarySample> few_numbers(int count) {
    std::vector<PrimarySample> out;
    for (int i = 0; i < 16; ++i) {
        PrimarySample u;
        for (int k = 0; k < std::max(count, 2); ++k) u[k] = std::fmod(0.5 + i * 0.6180339887 * (k + 1), 1.0);
        out.push_back(u);
    }
    return out;
}

void note(
    SmallFault& to, const PrimarySample& u, const Draw& d, double p, const char* what, std::optional<Vec3d> wo = {}) {
    if (to.times++ == 0) {
        to.first = {.u = u, .draw = d, .p = p, .expected = 0};
        to.what = what;
        to.wo = wo;
    }
}

}  // namespace

std::vector<Vec3d> special_directions() {
    std::vector<Vec3d> exact_directions, out;
    constexpr double c = 0.6, s = 0.8;
    for (double a : {-1.0, 1.0}) {
        exact_directions.insert(exact_directions.end(), {{a, 0, 0}, {0, a, 0}, {0, 0, a}});
        for (double b : {-1.0, 1.0})
            exact_directions.insert(exact_directions.end(), {{c * a, s * b, 0}, {c * a, 0, s * b}, {0, c * a, s * b}});
    }
    for (Vec3d w : exact_directions) {
        out.push_back(w);
        for (double e : {-ulp, ulp}) {
            if (w.x == 0) out.push_back({e, w.y, w.z});
            if (w.y == 0) out.push_back({w.x, e, w.z});
            if (w.z == 0) out.push_back({w.x, w.y, e});
        }
    }
    for (double a : {-1.0, 1.0})
        for (double tilt : {1e-5, 5e-4}) out.insert(out.end(), {{tilt, 0, a}, {0, -tilt, a}, {c * tilt, s * tilt, a}});
    for (Vec3d& w : out) w = w * (1 / std::sqrt(dot(w, w)));
    // Lengths one step of single precision off 1, along axes and oblique: sqrt(1 - z^2) fails there.
    for (Vec3d w : {Vec3d{0, 0, 1}, Vec3d{0, 0, -1}, Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0.48, 0.36, 0.8},
             Vec3d{0.48, -0.36, -0.8}})
        for (double length : {1 + 2 * ulp, 1 - ulp}) out.push_back(w * length);
    return out;
}

namespace {

/// Directions into which a smooth boundary sends w_o: the mirror direction, straight on, and those of the index.
std::vector<Vec3d> smooth_directions(const Traits& traits, Vec3d wo) {
    std::vector<Vec3d> out = {{-wo.x, -wo.y, wo.z}};
    if (traits.delta) out.push_back(-wo);
    for (int c = 0; traits.eta && c < 3; ++c) {
        const double e = wo.z > 0 ? channel_of(*traits.eta, c) : 1 / channel_of(*traits.eta, c);
        const double squared_cosine = 1 - (sqr(wo.x) + sqr(wo.y)) / sqr(e);
        if (squared_cosine > 0)
            out.push_back({-wo.x / e, -wo.y / e, wo.z > 0 ? -std::sqrt(squared_cosine) : std::sqrt(squared_cosine)});
    }
    return out;
}

}  // namespace

std::optional<SmallFault> special_places(
    const SamplerAdapter& adapter, int technique, std::span<const Vec3d> ordinary) {
    if (!adapter.can_draw()) return {};
    const Traits traits = adapter.traits();
    const std::vector<Vec3d> special = special_directions();
    const std::vector<PrimarySample> u = few_numbers(traits.numbers);
    SmallFault out{Family::corners};
    std::vector<Draw> draws(u.size());
    std::vector<Pair> pairs;
    for (Vec3d wo : special) {
        if (!answers_for(traits, wo) || traits.wo == Traits::WoDomain::none) continue;
        std::fill(draws.begin(), draws.end(), Draw{});
        adapter.sample(technique, wo, u, draws);
        out.trials += static_cast<double>(u.size());
        for (std::size_t i = 0; i < u.size(); ++i) {
            if (const auto fault = fault_of(draws[i], traits)) note(out, u[i], draws[i], 0, *fault, wo);
            else if (draws[i].pdf > 0) pairs.push_back({wo, draws[i].wi});
        }
    }
    for (std::size_t i = 0; i < std::min(most_ordinary, ordinary.size()); ++i)
        for (Vec3d wi : special) pairs.push_back({ordinary[i], wi});
    if (traits.has_surface()) {
        for (Vec3d wo : special)
            if (answers_for(traits, wo)) pairs.push_back({wo, {-wo.x, -wo.y, wo.z}});
        for (Vec3d wo : ordinary)
            for (Vec3d wi : smooth_directions(traits, wo)) pairs.push_back({wo, wi});
    }
    std::vector<double> p(pairs.size()), f(pairs.size());
    if (traits.has_pdf) adapter.pdf(technique, pairs, p);
    if (adapter.has_f()) adapter.f(pairs, f);
    out.trials += static_cast<double>(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {  // a density may have a pole in a single direction
        Draw draw;
        draw.wi = pairs[i].wi;
        std::optional<Vec3d> wo = pairs[i].wo;
        if (traits.wo == Traits::WoDomain::none) wo.reset();
        if (std::isnan(p[i]) || p[i] < 0) note(out, {}, draw, p[i], "pdf(w) is not a number >= 0", wo);
        else if (std::isnan(f[i]) || f[i] < 0) note(out, {}, draw, f[i], "f(w) is not a number >= 0", wo);
    }
    return out.times > 0 ? std::optional(out) : std::nullopt;
}

namespace {

/// f |cos|^k by channel for pairs; k = 1 for phase functions.
std::vector<Vec3d> f_of(const SamplerAdapter& adapter, std::span<const Pair> pairs) {
    std::vector<Vec3d> out(pairs.size());
    if (adapter.traits().channels == 3) {
        adapter.f_channels(pairs, out);
    } else {
        std::vector<double> y(pairs.size());
        adapter.f(pairs, y);
        for (std::size_t i = 0; i < y.size(); ++i) out[i] = {y[i], y[i], y[i]};
    }
    return out;
}

}  // namespace

double reciprocal_ratio(const Traits& traits, const Pair& p, int channel) {
    if (p.wo.z * p.wi.z > 0 || !traits.eta) return 1;
    const double eta2 = sqr(channel_of(*traits.eta, channel));
    return (p.wo.z > 0) == !traits.importance ? eta2 : 1 / eta2;
}

namespace {

bool differ(double a, double b, double tolerance) { return std::fabs(a - b) > tolerance * std::max(a, b) + 1e-30; }

}  // namespace

std::optional<SmallFault> reciprocity(const SamplerAdapter& adapter, const StreamKey& key) {
    const Traits traits = adapter.traits();
    if (!adapter.has_f() || !traits.reciprocal || !traits.has_surface()) return {};
    const bool is_two_sided = traits.wo == Traits::WoDomain::both;
    Stream stream(key);
    const auto draw_direction = [&](bool is_below) { return random_direction(stream, is_below, 0.02); };
    std::vector<Pair> forward_pairs, reverse_pairs;
    for (int i = 0; i < 256; ++i) {
        const Pair p{draw_direction(is_two_sided && (i & 1)), draw_direction(is_two_sided && (i & 2))};
        forward_pairs.push_back(p);
        reverse_pairs.push_back({p.wi, p.wo});
    }
    const std::vector<Vec3d> f = f_of(adapter, forward_pairs), g = f_of(adapter, reverse_pairs),
                             repeated_f = f_of(adapter, forward_pairs);
    const int channels = traits.channels == 3 ? 3 : 1;
    SmallFault out{.family = Family::reciprocity, .trials = 256.0 * channels, .what = "f(a, b) differs from f(b, a)"};
    for (std::size_t i = 0; i < forward_pairs.size(); ++i)
        for (int c = 0; c < channels; ++c) {
            const Pair& p = forward_pairs[i];
            const double a = channel_of(f[i], c), b = channel_of(g[i], c);
            if (differ(a, channel_of(repeated_f[i], c), same_number)) return {};  // a random estimate
            const bool is_across = p.wo.z * p.wi.z < 0;
            Draw draw;
            draw.wi = p.wi;
            if ((!is_across || traits.eta) && differ(a * reciprocal_ratio(traits, p, c), b, reciprocity_tolerance)) {
                note(out, {}, draw, a, out.what);
                out.first.expected = b;
            }
        }
    // A few of 256 pairs may be at the edge of the support of f, where the half vector is rounded.
    if (out.times <= tolerated_breaks || both_ways(adapter, key) == BothWays::phase_function) return {};
    return out;
}

namespace {

constexpr const char* not_one = "MIS weights do not sum to 1";
constexpr const char* without_density =
    "A sampler has MIS weight where its density is 0, so that the weights of the others sum to less than 1";

/// Directions that one technique draws, with the weights of all techniques there.
struct WeightedDraws {
    std::vector<Pair> pairs;
    std::vector<std::size_t> rows;  // indices of the draws
    std::vector<double> sum;
    std::vector<int> empty;  // a technique whose density is 0 there; -1: none

    WeightedDraws(const SamplerAdapter& adapter, Vec3d wo, const std::vector<Draw>& draws) {
        for (std::size_t i = 0; i < draws.size(); ++i)
            if (draws[i].pdf > 0 && draws[i].wi.z > 0) {
                pairs.push_back({wo, draws[i].wi});
                rows.push_back(i);
            }
        sum.resize(pairs.size());
        empty.assign(pairs.size(), -1);
        std::vector<double> w(pairs.size()), p(pairs.size());
        for (int k = 0; k < adapter.techniques(); ++k) {
            adapter.mis_weight(k, pairs, w);
            adapter.exact_pdf(k, pairs, p);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                sum[i] += w[i];
                if (p[i] == 0) empty[i] = k;
            }
        }
    }
};

}  // namespace

std::optional<SmallFault> mis_weights(const SamplerAdapter& adapter, Vec3d wo, const StreamKey& key) {
    if (adapter.techniques() < 2) return {};
    const Traits traits = adapter.traits();
    SmallFault out{.family = Family::mis};
    double small_sums = 0;  // number of draws where a density is 0 and the weights sum to less than 1
    for (int t = 0; t < adapter.techniques(); ++t) {
        const std::vector<PrimarySample> u = first_numbers(key, 512, traits);
        std::vector<Draw> draws(u.size());
        adapter.sample(t, wo, u, draws);
        const WeightedDraws w(adapter, wo, draws);
        out.trials += static_cast<double>(w.pairs.size());
        for (std::size_t i = 0; i < w.pairs.size(); ++i) {
            if (std::fabs(w.sum[i] - 1) <= reciprocity_tolerance) continue;
            note(out, u[w.rows[i]], draws[w.rows[i]], w.sum[i], "", wo);
            if (!(std::fabs(w.sum[i] - 1) <= std::fabs(out.size))) out.size = w.sum[i] - 1;
            if (w.empty[i] < 0 || !(w.sum[i] < 1)) continue;
            if (small_sums++ == 0)
                out.first = {.u = u[w.rows[i]], .draw = draws[w.rows[i]], .p = w.sum[i], .expected = w.empty[i] + 1.0};
        }
    }
    if (!(out.times > tolerated_breaks)) return {};
    out.what = small_sums == out.times ? without_density : not_one;
    if (small_sums < out.times) out.first.expected = 0;
    return out;
}

}  // namespace crescent::check
