// What a trial draws, on the first seed and on fresh ones: pdf(w), f and coordinates of each draw, asked for once. A
// limited sampler's batches are as large as what is left of its questions. What rounding allows is read off the digits
// of the directions: decimal, float or double.
#include "trials/draws.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "simd/random.h"
#include "subjects/numbers.h"
#include "subjects/recorded.h"

namespace crescent::inline trials {

namespace {

bool is_usable(const Draw& d) {
    return std::isfinite(d.pdf) && d.pdf >= 0 && (d.pdf == 0 || is_finite(d.wi)) &&
        (!d.weight || (std::isfinite(*d.weight) && is_finite(d.weights)));
}

/// Up to one draw in ten thousand hides no other fault: it is put aside, and `valid` tells of it.
void drop_unusable(SampleBatch& b) {
    std::size_t bad = 0;
    for (const Draw& d : b.draws) bad += !is_usable(d);
    if (bad == 0 || 10000 * bad > b.draws.size()) return;
    const std::size_t good =
        static_cast<std::size_t>(std::find_if(b.draws.begin(), b.draws.end(), is_usable) - b.draws.begin());
    for (std::size_t i = 0, last = good; i < b.draws.size(); ++i) {
        if (is_usable(b.draws[i])) {
            last = i;
            continue;
        }
        b.dropped.emplace_back(b.u[i], b.draws[i]);
        b.draws[i] = b.draws[last];
        b.u[i] = b.u[last];
    }
}

bool multiples_of(std::span<const Draw> draws, double unit) {
    for (const Draw& d : draws)
        for (double v : {d.wi.x, d.wi.y, d.wi.z})
            if (std::fabs(v / unit - std::round(v / unit)) > 1e-6) return false;
    return true;
}

double rounding_of(std::span<const Draw> all, int bits) {
    if (bits > 0) return bits <= 24 ? 0x1p-24 : 0x1p-50;
    std::vector<Draw> draws;
    for (const Draw& d : all) {
        if (draws.size() == 256) break;
        if (d.pdf > 0 || d.delta > 0) draws.push_back(d);
    }
    for (int digits = 3; digits <= 8; ++digits)
        if (multiples_of(draws, math::pow(10.0, -digits))) return 0.5 * math::pow(10.0, -digits);
    for (const Draw& d : draws)
        for (double v : {d.wi.x, d.wi.y, d.wi.z})
            if (static_cast<double>(static_cast<float>(v)) != v) {
                return std::fabs(v - static_cast<double>(static_cast<float>(v))) < 2e-9 * std::fabs(v) ? 0x1p-24
                                                                                                       : 0x1p-50;
            }
    return 0x1p-24;
}

}  // namespace

Draws::Draws(const Trial& t, const TestSettings& r, std::uint32_t index) : Questions(t, r, index), seed_(r.seed) {
    for (int k = 0; k < subject.techniques(); ++k) first_.push_back(draw(k, 0));
    direction_resolution_ = rounding_of(first_[0].draws, traits.bits);
    scatter_ = look_for_scatter(*this);
    for (SampleBatch& b : first_) count_nothing(b);
    look_below();
}

void Draws::redraw(std::uint32_t seed) {
    seed_ = seed;
    confirming_ = {};
    first_weights_ = {};
    for (std::size_t k = 0; k < first_.size(); ++k) first_[k] = draw(static_cast<int>(k), 0);
}

SampleBatch Draws::draw(int technique, int round) const {
    std::optional<SampleBatch>* kept =
        subject.limited() && round == 1 && technique < 2 ? &confirming_[static_cast<std::size_t>(technique)] : nullptr;
    if (kept && *kept) return **kept;  // a limited sampler is asked for it once
    SampleBatch b;
    if (const auto* tape = dynamic_cast<const RecordedSubject*>(&subject)) {
        tape->half(round, b.u, b.draws);
    } else {
        const std::uint64_t n = round == 0 ? settings.draws : confirming_draws();
        const std::uint32_t seed = seed_of(seed_, static_cast<std::uint32_t>(round) * 7919u);
        b.u.resize(n);
        b.draws.resize(n);
        for (std::uint64_t i = 0; i < n; ++i) {
            subject.make_way(1);
            b.u[i] = drawn_numbers(seed, index_, i, static_cast<std::uint32_t>(technique), traits.numbers);
        }
        subject.sample(technique, trial.wo, b.u, b.draws);
    }
    drop_unusable(b);
    b.pdf = pdf_of_drawn(technique, b.draws);
    count_nothing(b);
    if (kept) *kept = b;
    return b;
}

std::uint64_t Draws::confirming_draws() const {
    if (!subject.limited()) return 4 * settings.draws;
    // Each is asked three times. A part of what is kept for later may go into them: what is wrong is wrong first.
    return std::max<std::uint64_t>(
        affordable(12 * settings.draws) / 3, std::min<std::uint64_t>(settings.draws / 2, left() / 9));
}

bool Draws::confirmed_by_fewer() const {
    return std::ranges::any_of(
        confirming_, [&](const std::optional<SampleBatch>& b) { return b && b->draws.size() < settings.draws; });
}

void Draws::count_nothing(SampleBatch& b) const {
    if (scatter_.pdf()) settle_zeros(b);
    b.nothing = b.deltas = 0;
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        subject.make_way(1);
        if (is_null_sample(b.draws[i], b.pdf[i])) ++b.nothing, b.deltas += b.draws[i].delta > 0;
    }
}

const std::vector<double>& Draws::f_of_drawn(const SampleBatch& b) const {
    if (b.f.size() == b.draws.size()) return b.f;
    std::vector<Vec3d> wi;
    if (!subject.has_f()) {
        for (const Draw& d : b.draws) b.f.push_back(d.pdf > 0 && counts(d.wi) ? d.f.value_or(0) : 0);
        return b.f;
    }
    for (const Draw& d : b.draws)
        if (d.pdf > 0 && counts(d.wi) && is_finite(d.wi)) wi.push_back(d.wi);
    const bool coloured = traits.channels == 3;
    const std::vector<Vec3d> by_channel = coloured ? f_channels(wi) : std::vector<Vec3d>{};
    const std::vector<double> value = coloured ? std::vector<double>{} : f(wi);
    b.f.assign(b.draws.size(), 0);
    b.f_channels.assign(coloured ? b.draws.size() : 0, Vec3d{});
    std::size_t next = 0;
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        subject.make_way(1);
        if (!(b.draws[i].pdf > 0) || !counts(b.draws[i].wi) || !is_finite(b.draws[i].wi)) continue;
        if (coloured) b.f_channels[i] = by_channel[next];
        b.f[i] = coloured ? luminance(by_channel[next]) : value[next];
        ++next;
    }
    return b.f;
}

/// A draw of nothing, or of NaN, has no direction to ask about: 0.
std::vector<double> Draws::pdf_of_drawn(int technique, std::span<const Draw> draws) const {
    std::vector<Vec3d> wi;
    for (const Draw& d : draws)
        if (d.pdf > 0 && is_finite(d.wi)) wi.push_back(d.wi);
    const std::vector<double> asked = pdf(technique, wi);
    std::vector<double> p(draws.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i < draws.size(); ++i)
        if (draws[i].pdf > 0 && is_finite(draws[i].wi)) p[i] = asked[next++];
    return p;
}

const std::vector<Vec2d>& Draws::coordinates_of(const SampleBatch& b, const SphereMap& map) const {
    if (b.axis && length(*b.axis - map.frame.n) == 0) return b.coordinates;
    b.coordinates.assign(b.draws.size(), {});
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        subject.make_way(1);
        if (!is_null_sample(b.draws[i], b.pdf[i])) b.coordinates[i] = map.coordinates(b.draws[i].wi);
    }
    b.axis = map.frame.n;
    return b.coordinates;
}

bool Draws::weighs() const {
    if (!subject.has_drawn_f()) return false;
    const std::vector<Draw>& draws = first_[0].draws;
    return traits.has_pdf ||
        std::any_of(draws.begin(), draws.end(), [](const Draw& d) { return d.weight.has_value(); });
}

std::vector<double> Draws::weights(std::span<const SampleBatch> techniques, bool even) const {
    std::vector<double> x(techniques[0].draws.size());
    for (std::size_t t = 0; t < techniques.size(); ++t) {
        const SampleBatch& b = techniques[t];
        std::vector<Pair> at;
        for (const Draw& d : b.draws) at.push_back({trial.wo, d.pdf > 0 && counts(d.wi) ? d.wi : Vec3d{0, 0, 1}});
        std::vector<double> mis(at.size());
        subject.mis_weight(static_cast<int>(t), at, mis);
        const std::vector<double>& value = f_of_drawn(b);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const Draw& d = b.draws[i];
            if (!(d.pdf > 0 || d.delta > 0) || !counts(d.wi)) continue;
            const double of_one = d.weight ? *d.weight : value[i] * std::fabs(d.wi.z) / d.pdf;
            x[i] += mis[i] * of_one * (even ? 1 : light(d.wi));
        }
    }
    return x;
}

const std::vector<double>& Draws::first_weights(bool even) const {
    std::vector<double>& kept = first_weights_[even];
    if (kept.empty()) kept = weights(first_, even);
    return kept;
}

}  // namespace crescent::inline trials
