// Rows of the regression are the leaves in which p expects a draw; the draws have no influence on this choice.
#include "check/explain/factors.h"

#include <algorithm>
#include <cmath>

#include "check/explain/hypothesis.h"

namespace crescent::check {

namespace {

constexpr double wide_leaf = 0.02;       // rad: in a wider leaf a factor is averaged over four points
constexpr std::size_t most_factors = 3;  // that are tested further
constexpr double to_simple = 0.03;       // an exponent is rounded to a multiple of 1/2 within this distance
constexpr double most_power = 0.5;       // largest power: for a nearly uniform density any power is likely
constexpr double least_power = 1e-3;     // least difference of the exponent from 1

double average(const Factor& f, Vec3d wo, const ChartRect& rect) {
    if (std::max(rect.theta_width(), rect.phi_width()) < wide_leaf) return f.value(wo, from_chart(rect.at(0.5, 0.5)));
    double sum = 0;
    for (double x : {0.25, 0.75})
        for (double y : {0.25, 0.75}) sum += f.value(wo, from_chart(rect.at(x, y))) / 4;
    return sum;
}

/// The last x of a row is ln q.
std::vector<Row> rows_of(std::span<const Place> places, const std::vector<Factor>& factors) {
    std::vector<Row> rows;
    for (std::size_t g = 0; g < places.size(); ++g) {
        const CheckAt& c = *places[g].at;
        const double n = c.observations.independent;
        double h = 0, h2 = 0;
        for (const LeafIntegral& l : c.integrals.leaves) h += l.bridge.value, h2 += l.second;
        if (!(h > 0)) continue;
        for (std::size_t l = 0; l < c.integrals.leaves.size(); ++l) {
            const LeafIntegral& leaf = c.integrals.leaves[l];
            if (leaf.bridge.value * n < 1) continue;
            Row r{g, c.observations.leaves[l], leaf.bridge.value * n, leaf.bridge.variance * n * n, h2 / h, {}};
            const Leaf& of_tree = c.plan->tree.leaves()[l];
            for (const Factor& f : factors)
                r.x.push_back(math::log(average(f, places[g].check_case->wo, c.plan->tree.rect(of_tree)) + 1e-12));
            r.x.push_back(math::log(of_tree.q));
            rows.push_back(std::move(r));
        }
    }
    return rows;
}

/// The simple exponent that agrees with a fitted one: 1 or -1 before 1/2, 2 and others; 0 if there is none.
double simple_of(double b, double error) {
    const double known = std::max(3 * error, to_simple);
    if (std::fabs(b) < 4 * error) return 0;
    for (double simple : {1.0, 2.0, 0.5, 1.5, 3.0})
        if (std::fabs(std::fabs(b) - simple) < known) return b > 0 ? simple : -simple;
    return 0;
}

double power_of(double x, double b) { return x > 0 ? math::exp(b * math::log(x)) : 0; }

/// The known number next to a constant: 1, or the usual constant of the factor.
double known_constant(double constant, double usual, double b) {
    for (double known : {1.0, power_of(usual, b)})
        if (std::fabs(constant / known - 1) < 0.02) return known;
    return constant;
}

/// Sets the gain from the log likelihood gained by a factor over constants alone, and that of the constants from the
/// masses.
void set_gain(Hypothesis& h, double likelihood, std::span<const Place> places) {
    double draws = 0, by_masses = 0;
    for (const Place& place : places) {
        const double n = place.at->observations.independent, ratio = std::max(mass_ratio(*place.at).ratio, 1e-12);
        draws += n, by_masses += n * (ratio - 1 - math::log(ratio));
    }
    h.gain = (likelihood + by_masses) / draws, h.draws = draws;
    h.error = std::sqrt(2 * std::max(likelihood, 1.0)) / draws;
}

}  // namespace

Hypothesis times(const Factor& f, double b) {
    Hypothesis h;
    h.name = f.name;
    h.free = true;
    h.density = [f, b](const SamplerAdapter& s, int technique, std::span<const Pair> at, std::span<double> out) {
        s.exact_pdf(technique, at, out);
        for (std::size_t i = 0; i < at.size(); ++i)
            if (out[i] > 0) out[i] *= power_of(f.value(at[i].wo, at[i].wi), b);
    };
    return h;
}

std::vector<FactorHypothesis> factor_hypotheses(std::span<const Place> places) {
    const std::vector<Factor> factors = factors_for(places[0].traits, places[0].check_case->light);
    const std::vector<Row> rows = rows_of(places, factors);
    std::vector<FactorHypothesis> out;
    if (rows.size() < 32) return out;
    const Fit even = fit(rows, places.size(), {});
    std::vector<std::pair<Fit, std::size_t>> fits;
    for (std::size_t k = 0; k < factors.size(); ++k) {
        Fit f = fit(rows, places.size(), {k});
        const double b = f.exponents[0];
        const bool can_be = factors[k].any_exponent ? std::fabs(b) > 5 * f.errors[0] : simple_of(b, f.errors[0]) != 0;
        if (!std::isfinite(f.likelihood) || !(f.errors[0] < 0.2) || !can_be) continue;
        fits.emplace_back(std::move(f), k);
    }
    std::ranges::sort(fits, std::greater<>(), [](const auto& one) { return one.first.likelihood; });
    if (fits.size() > most_factors) fits.resize(most_factors);
    for (const auto& [f, k] : fits) {
        const double b = f.exponents[0], exponent = factors[k].any_exponent ? b : simple_of(b, f.errors[0]);
        FactorHypothesis found{
            times(factors[k], exponent), factors[k].name, exponent, b, f.errors[0], factors[k].usual_constant};
        for (double c : f.constants)
            found.hypothesis.constants.push_back(known_constant(c, factors[k].usual_constant, exponent));
        set_gain(found.hypothesis, f.likelihood - even.likelihood, places);
        if (found.hypothesis.helps()) out.push_back(std::move(found));
    }
    return out;
}

std::optional<FactorHypothesis> power_hypothesis(std::span<const Place> places) {
    const std::vector<Row> rows = rows_of(places, {});
    if (rows.size() < 32) return {};
    const Fit f = fit(rows, places.size(), {0});
    const double b = f.exponents[0];
    if (!(std::fabs(b) > std::max(least_power, 4 * f.errors[0])) || !(std::fabs(b) < most_power)) return {};
    FactorHypothesis out{{}, "p", b, b, f.errors[0], 1};
    out.hypothesis.name = "p";
    out.hypothesis.free = true;
    out.hypothesis.constants = f.constants;
    out.hypothesis.density = [b](const SamplerAdapter& s, int technique, std::span<const Pair> at,
                                 std::span<double> to) {
        s.exact_pdf(technique, at, to);
        for (double& v : to) v = v > 0 ? v * power_of(v, b) : 0;
    };
    set_gain(out.hypothesis, f.likelihood - fit(rows, places.size(), {}).likelihood, places);
    return out.hypothesis.helps() ? std::optional(out) : std::nullopt;
}

}  // namespace crescent::check
