// Tests the supposed density with the check itself, as the density of a sampler with the same draws.
#include "check/explain/hypothesis.h"

#include <algorithm>
#include <cmath>

#include "check/explain/constants.h"
#include "check/sources/check_case.h"

namespace crescent::check {

namespace {

/// The sampler with the supposed density in place of its own. `h` must outlive it.
DecoratedSampler supposed(std::shared_ptr<const SamplerAdapter> sampler, const Hypothesis& h, double constant) {
    const auto evaluate = [&h, constant](
                              const SamplerAdapter& inner, const SamplerQuery& query, const SamplerAnswers& out) {
        const bool is_density = query.kind == SamplerQuery::Kind::pdf || query.kind == SamplerQuery::Kind::exact_pdf;
        if (!is_density) return inner.evaluate(query, out);
        h.density(inner, query.technique, query.pairs, out.values);
        for (double& v : out.values) v *= constant;
    };
    return {std::move(sampler), evaluate, without_f};
}

/// A look of the size at which the fault was found, after a small look for large differences.
CheckBudget budget_for(const CheckAt& found, bool few) {
    const std::uint32_t n = found.looks == 1 ? 1u << 15 : few ? 1u << 16 : 1u << 17;
    CheckBudget b = CheckBudget::limited(6.0 * n);
    b.looks = 2;
    return b;
}

bool of_density(Family f) { return info(f).verdict == "density" || info(f).verdict == "normalised"; }

bool density_is_wrong(const CheckAt& c) {
    return std::ranges::any_of(c.findings, [](const Finding& f) { return of_density(f.first.family); });
}

bool difference_remains(const CheckAt& c) {
    return density_is_wrong(c) ||
        std::ranges::any_of(c.answers, [](const Answer& a) { return of_density(a.family) && a.p < remaining_level; });
}

void draw_at(Place& place, std::uint32_t count) {
    Source source = place.source();
    const StreamKey key = place.key(7, Purpose::pairs, 1);
    const std::vector<PrimarySample> u = first_numbers(key, count, source.traits);
    std::vector<Draw> draws(count);
    source.draw(u, draws);
    const auto [rows, w, p] = usable_draws(source, draws);
    const CheckAt& c = *place.at;
    for (std::size_t i = 0; i < w.size(); ++i) {
        place.w.push_back(w[i]);
        place.p.push_back(p[i]);
        const std::size_t l = c.plan->tree.find(to_chart(w[i]));
        const double claimed = c.integrals.leaves[l].bridge.value, n = c.observations.independent;
        const double area = c.plan->tree.rect(c.plan->tree.leaves()[l]).area();
        const double here = std::max(static_cast<double>(c.observations.counts[l]), 1.0);
        // The logarithm of a count is too low by 1 / (2 count) on average.
        place.implied.push_back(math::exp(0.5 / here) *
            (claimed > 0 && c.observations.leaves[l] > 0 && p[i] > 0 ? p[i] * c.observations.leaves[l] / (claimed * n)
                                                                     : here / (n * area)));
    }
    place.of = count;
    place.map = map_densities(source, place.key(23, Purpose::jacobian, 1));
}

}  // namespace

MassRatio mass_ratio(const CheckAt& c) {
    const Observations& o = c.observations;
    const double n = std::max(o.independent, 1.0);
    const auto ratio_of = [&](int q) {
        const Sums& s = o.sums[static_cast<std::size_t>(q)];
        const Estimate& claimed = c.integrals.sums[static_cast<std::size_t>(q)];
        const double drawn = s.sum / n, ratio = drawn > 0 ? claimed.value / drawn : 0;
        const double variance = std::max(s.square / n - drawn * drawn, 0.0) / n;
        const double error = drawn > 0 ? std::sqrt(claimed.variance + ratio * ratio * variance) / drawn : 1;
        return MassRatio{.drawn = drawn, .claimed = claimed.value, .ratio = ratio, .error = error};
    };
    MassRatio out = ratio_of(mass);
    const MassRatio other = ratio_of(bridge);
    if (other.error < out.error / 2) {
        out.ratio = other.ratio;
        out.error = other.error;
    }
    return out;
}

double Place::log_of(double density) const {
    return std::max(
        std::isfinite(density) && density > 0 ? math::log(density) : -1e300, at->plan->median_log_p - no_density);
}

double Place::mean_log(std::span<const double> density) const {
    double sum = 0;
    for (double d : density) sum += log_of(d);
    return density.empty() ? 0 : sum / static_cast<double>(density.size());
}

std::vector<Place> places_of(std::span<const CheckCase> check_cases, const CheckOutcome& outcome,
    std::size_t largest_count, std::uint32_t count) {
    std::vector<Place> wrong;
    for (std::size_t k = 0; k < outcome.at.size(); ++k)
        for (const CheckAt& c : outcome.at[k])
            if (density_is_wrong(c) && c.plan && c.plan->drawn > 0) {
                const CheckCase& t = check_cases[outcome.check_cases[k]];
                wrong.push_back({&t, &c, outcome.check_cases[k], t.adapter->traits(), {}, {}, {}, 0, {}});
            }
    // Selects entries over the whole list, which goes from n to grazing and below.
    std::vector<Place> out;
    for (std::size_t k = 0; k < std::min(largest_count, wrong.size()); ++k)
        out.push_back(wrong[(2 * k + 1) * wrong.size() / (2 * std::min(largest_count, wrong.size()))]);
    for (Place& p : out) draw_at(p, count);
    std::erase_if(out, [](const Place& p) { return p.w.size() < 64; });
    return out;
}

void score(Hypothesis& h, std::span<const Place> places) {
    Sums gain;
    double after = 0, before = 0, draws = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const Place& place = places[k];
        const MassRatio masses = mass_ratio(*place.at);
        const double more = ((h.masses.empty() ? 1 : h.masses[k]) - 1) * masses.claimed / masses.drawn;
        std::vector<Pair> pairs;
        for (Vec3d w : place.w) pairs.push_back({place.check_case->wo, w});
        std::vector<double> p(pairs.size());
        h.density(place.adapter(), place.technique(), pairs, p);
        for (std::size_t i = 0; i < p.size(); ++i) {
            const double of_p = place.log_of(place.p[i]), of_h = place.log_of(p[i] * h.constant(k));
            const double of_draws = place.log_of(place.implied[i]);
            gain.add(of_h - of_p - more);
            ++draws;
            after += of_draws - of_h;
            before += of_draws - of_p;
        }
    }
    if (draws == 0) return;
    h.gain = gain.sum / draws;
    h.draws = draws;
    h.error = std::sqrt(std::max(gain.square / draws - h.gain * h.gain, 0.0) / draws);
    h.explained = before > 0 ? std::min(1 - after / before, 1.0) : 0;
}

bool is_below_map(const Hypothesis& h, std::span<const Place> places) {
    double below = 0, points = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        std::vector<Pair> pairs;
        for (const MapDensity& m : places[k].map) pairs.push_back({places[k].check_case->wo, m.draw.wi});
        std::vector<double> supposed(pairs.size());
        h.density(places[k].adapter(), places[k].technique(), pairs, supposed);
        for (std::size_t i = 0; i < pairs.size(); ++i, ++points) {
            const MapDensity& m = places[k].map[i];
            const double density = supposed[i] * h.constant(k);
            below += density + std::fabs(density - m.p) / 2 + 2 * m.error * m.drawn < m.drawn;
        }
    }
    return below > most_below_map * points;
}

bool are_equivalent(const Hypothesis& a, const Hypothesis& b, std::span<const Place> places) {
    double same = 0, draws = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        std::vector<Pair> pairs;
        for (Vec3d w : places[k].w) pairs.push_back({places[k].check_case->wo, w});
        std::vector<double> p(pairs.size()), q(pairs.size());
        a.density(places[k].adapter(), places[k].technique(), pairs, p);
        b.density(places[k].adapter(), places[k].technique(), pairs, q);
        for (std::size_t i = 0; i < pairs.size(); ++i, ++draws)
            same += std::fabs(p[i] * a.constant(k) - q[i] * b.constant(k)) <= same_density * p[i] * a.constant(k);
    }
    return same >= same_at * draws;
}

namespace {

CheckAt checked_again(const SamplerAdapter& corrected, const Place& place, std::uint32_t seed) {
    return check_sampler_at(corrected, place.technique(), place.check_case->wo,
        CaseData{place.check_case->light, static_cast<std::uint16_t>(place.number), {}},
        budget_for(*place.at, corrected.serial()), seed ^ 0x9e3779b9u);
}

}  // namespace

bool follows_density(const SamplerAdapter& corrected, std::span<const Place> places, std::uint32_t seed) {
    const auto remains = [&](const Place& place) {
        const CheckAt c = checked_again(corrected, place, seed);
        return difference_remains(c) &&
            (density_is_wrong(c) || difference_remains(checked_again(corrected, place, ~seed)));
    };
    return std::ranges::none_of(places, remains);
}

bool passes(Hypothesis& h, std::span<const Place> places, std::uint32_t seed) {
    if (h.constants.empty()) h.constants.assign(places.size(), 1);
    for (std::size_t k = 0; k < places.size(); ++k) {
        const Place& place = places[k];
        const auto check = [&](std::uint32_t with) {
            return checked_again(supposed(place.check_case->adapter, h, h.constants[k]), place, with);
        };
        CheckAt c = check(seed);
        if (difference_remains(c) && h.free) {
            const double claimed = c.integrals.sums[mass].value;
            const double drawn = c.observations.sums[mass].sum / std::max(c.observations.independent, 1.0);
            if (!(claimed > 0) || !(drawn > 0)) return false;
            h.constants[k] *= drawn / claimed;
            c = check(seed);
        }
        // By chance a right density has a family below `remaining_level`; not with two seeds.
        if (difference_remains(c) && (density_is_wrong(c) || difference_remains(check(~seed)))) return false;
    }
    return !places.empty();
}

}  // namespace crescent::check
