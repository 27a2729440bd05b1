// Tests the supposed density with the check itself, as the density of a sampler with the same draws.
#include "check/explain/hypothesis.h"

#include <algorithm>
#include <cmath>

#include "check/decide/jacobian.h"
#include "check/explain/constants.h"
#include "check/sources/check_case.h"

namespace crescent::check {

namespace {

/// The sampler with the supposed density in place of its own. `h` must outlive it.
DecoratedSampler supposed_sampler(std::shared_ptr<const SamplerAdapter> sampler, const Hypothesis& h, double constant) {
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
CheckBudget budget_for(const CheckAt& check, bool is_serial) {
    const std::uint32_t n = check.looks == 1 ? 1u << 15 : is_serial ? 1u << 16 : 1u << 17;
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
    const std::vector<Draw> draws = source.draw(u);
    const auto [rows, w, p] = usable_draws(source, draws);
    const CheckAt& c = *place.check;
    for (std::size_t i = 0; i < w.size(); ++i) {
        place.w.push_back(w[i]);
        place.p.push_back(p[i]);
        const std::size_t l = c.plan->tree.find(to_chart(w[i]));
        const double claimed_mass = c.integrals.leaves[l].bridge.value, n = c.observations.independent;
        const double area = c.plan->tree.rect(c.plan->tree.leaves()[l]).area();
        const double leaf_count = std::max(static_cast<double>(c.observations.counts[l]), 1.0);
        // The logarithm of a count is too low by 1 / (2 count) on average.
        place.implied.push_back(math::exp(0.5 / leaf_count) *
            (claimed_mass > 0 && c.observations.leaves[l] > 0 && p[i] > 0
                    ? p[i] * c.observations.leaves[l] / (claimed_mass * n)
                    : leaf_count / (n * area)));
    }
    place.draw_count = count;
    place.map = map_densities(source, place.key(23, Purpose::jacobian, 1));
}

}  // namespace

MassRatio mass_ratio(const CheckAt& c) {
    const Observations& o = c.observations;
    const double n = std::max(o.independent, 1.0);
    const auto ratio_of = [&](int q) {
        const Sums& s = o.sums[static_cast<std::size_t>(q)];
        const Estimate& claim = c.integrals.sums[static_cast<std::size_t>(q)];
        const double drawn_mass = s.sum / n, ratio = drawn_mass > 0 ? claim.value / drawn_mass : 0;
        const double variance = std::max(s.square / n - drawn_mass * drawn_mass, 0.0) / n;
        const double error = drawn_mass > 0 ? std::sqrt(claim.variance + ratio * ratio * variance) / drawn_mass : 1;
        return MassRatio{.drawn_mass = drawn_mass, .claimed_mass = claim.value, .ratio = ratio, .error = error};
    };
    MassRatio out = ratio_of(mass);
    const MassRatio bridge_ratio = ratio_of(bridge);
    if (bridge_ratio.error < out.error / 2) {
        out.ratio = bridge_ratio.ratio;
        out.error = bridge_ratio.error;
    }
    return out;
}

double Place::log_of(double density) const {
    return std::max(
        std::isfinite(density) && density > 0 ? math::log(density) : -1e300, check->plan->median_log_p - no_density);
}

double Place::mean_log(std::span<const double> density) const {
    double sum = 0;
    for (double d : density) sum += log_of(d);
    return density.empty() ? 0 : sum / static_cast<double>(density.size());
}

std::vector<Place> places_of(std::span<const CheckCase> check_cases, const CheckOutcome& outcome,
    std::size_t largest_count, std::uint32_t count) {
    std::vector<Place> wrong_places;
    for (std::size_t k = 0; k < outcome.checks.size(); ++k)
        for (const CheckAt& c : outcome.checks[k])
            if (density_is_wrong(c) && c.plan && c.plan->direction_count > 0) {
                const CheckCase& check_case = check_cases[outcome.check_cases[k]];
                wrong_places.push_back(
                    {&check_case, &c, outcome.check_cases[k], check_case.adapter->traits(), {}, {}, {}, 0, {}});
            }
    // Selects entries over the whole list, which goes from n to grazing and below.
    std::vector<Place> out;
    for (std::size_t k = 0; k < std::min(largest_count, wrong_places.size()); ++k)
        out.push_back(
            wrong_places[(2 * k + 1) * wrong_places.size() / (2 * std::min(largest_count, wrong_places.size()))]);
    for (Place& place : out) draw_at(place, count);
    std::erase_if(out, [](const Place& p) { return p.w.size() < 64; });
    return out;
}

void score(Hypothesis& h, std::span<const Place> places) {
    Sums gain;
    double remainder = 0, divergence = 0, draws = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const Place& place = places[k];
        const MassRatio masses = mass_ratio(*place.check);
        const double added_mass = ((h.masses.empty() ? 1 : h.masses[k]) - 1) * masses.claimed_mass / masses.drawn_mass;
        std::vector<Pair> pairs;
        for (Vec3d w : place.w) pairs.push_back({place.check_case->wo, w});
        std::vector<double> p(pairs.size());
        h.density(place.adapter(), place.technique(), pairs, p);
        for (std::size_t i = 0; i < p.size(); ++i) {
            const double log_p = place.log_of(place.p[i]), log_h = place.log_of(p[i] * h.constant(k));
            const double log_implied = place.log_of(place.implied[i]);
            gain.add(log_h - log_p - added_mass);
            ++draws;
            remainder += log_implied - log_h;
            divergence += log_implied - log_p;
        }
    }
    if (draws == 0) return;
    h.gain = gain.sum / draws;
    h.draws = draws;
    h.error = std::sqrt(std::max(gain.square / draws - h.gain * h.gain, 0.0) / draws);
    h.explained_share = divergence > 0 ? std::min(1 - remainder / divergence, 1.0) : 0;
}

bool is_below_map(const Hypothesis& h, std::span<const Place> places) {
    double below_count = 0, points = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        std::vector<Pair> pairs;
        for (const MapDensity& m : places[k].map) pairs.push_back({places[k].check_case->wo, m.draw.wi});
        std::vector<double> densities(pairs.size());
        h.density(places[k].adapter(), places[k].technique(), pairs, densities);
        for (std::size_t i = 0; i < pairs.size(); ++i, ++points) {
            const MapDensity& m = places[k].map[i];
            const double density = densities[i] * h.constant(k);
            below_count += density + std::fabs(density - m.p) / 2 + 2 * m.error * m.density < m.density;
        }
    }
    return below_count > most_below_map * points;
}

bool are_equivalent(const Hypothesis& a, const Hypothesis& b, std::span<const Place> places) {
    double agreements = 0, draws = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        std::vector<Pair> pairs;
        for (Vec3d w : places[k].w) pairs.push_back({places[k].check_case->wo, w});
        std::vector<double> p(pairs.size()), q(pairs.size());
        a.density(places[k].adapter(), places[k].technique(), pairs, p);
        b.density(places[k].adapter(), places[k].technique(), pairs, q);
        for (std::size_t i = 0; i < pairs.size(); ++i, ++draws)
            agreements += std::fabs(p[i] * a.constant(k) - q[i] * b.constant(k)) <= same_density * p[i] * a.constant(k);
    }
    return agreements >= same_share * draws;
}

namespace {

CheckAt checked_again(const SamplerAdapter& corrected, const Place& place, std::uint32_t seed) {
    return check_sampler_at(corrected, place.technique(), place.check_case->wo,
        CaseData{place.check_case->light, static_cast<std::uint16_t>(place.number), {}},
        budget_for(*place.check, corrected.serial()), seed ^ 0x9e3779b9u);
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
        const auto check = [&](std::uint32_t check_seed) {
            return checked_again(supposed_sampler(place.check_case->adapter, h, h.constants[k]), place, check_seed);
        };
        CheckAt c = check(seed);
        if (difference_remains(c) && h.has_free_constant) {
            const double claimed_mass = c.integrals.sums[mass].value;
            const double drawn_mass = c.observations.sums[mass].sum / std::max(c.observations.independent, 1.0);
            if (!(claimed_mass > 0) || !(drawn_mass > 0)) return false;
            h.constants[k] *= drawn_mass / claimed_mass;
            c = check(seed);
        }
        // By chance a right density has a family below `remaining_level`; not with two seeds.
        if (difference_remains(c) && (density_is_wrong(c) || difference_remains(check(~seed)))) return false;
    }
    return !places.empty();
}

}  // namespace crescent::check
