// Poisson regression by Newton's method: the ratio of observed to expected draws of a leaf, explained by the logarithms
// of candidate factors. Factors are added one at a time, the one with the largest gain in likelihood first.
#include "check/explain/regression.h"

#include <algorithm>
#include <cmath>

#include "check/explain/constants.h"
#include "check/explain/factors.h"
#include "check/explain/hypothesis.h"
#include "math/functions.h"
#include "math/statistics.h"

namespace crescent::check {

namespace {

constexpr int most_steps = 40;

/// Means and constants for given exponents.
struct Model {
    std::vector<double> mu, constants;
    double likelihood = 0;
};

Model model_of(std::span<const Row> rows, std::size_t groups, const Fit& f) {
    Model m;
    m.mu.resize(rows.size());
    std::vector<double> drawn_sums(groups), claimed_sums(groups);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        double eta = 0;
        for (std::size_t k = 0; k < f.factors.size(); ++k) eta += f.exponents[k] * rows[i].x[f.factors[k]];
        m.mu[i] = rows[i].expected * math::exp(std::clamp(eta, -largest_exponent, largest_exponent));
        drawn_sums[rows[i].group] += rows[i].observed;
        claimed_sums[rows[i].group] += m.mu[i];
    }
    for (std::size_t g = 0; g < groups; ++g)
        m.constants.push_back(claimed_sums[g] > 0 ? drawn_sums[g] / claimed_sums[g] : 1);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        m.mu[i] *= m.constants[rows[i].group];
        if (m.mu[i] > 0)
            m.likelihood += (rows[i].observed * math::log(m.mu[i] / rows[i].expected) - m.mu[i]) / rows[i].unit;
    }
    return m;
}

using Matrix = std::vector<std::vector<double>>;

/// Gradient and Fisher information of the exponents after elimination of the constants.
void derivatives(std::span<const Row> rows, std::size_t groups, const Fit& f, const Model& m,
    std::vector<double>& gradient, Matrix& information) {
    const std::size_t d = f.factors.size();
    Matrix mean(groups, std::vector<double>(d));
    std::vector<double> totals(groups, 1e-300);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        totals[rows[i].group] += m.mu[i];
        for (std::size_t k = 0; k < d; ++k) mean[rows[i].group][k] += m.mu[i] * rows[i].x[f.factors[k]];
    }
    for (std::size_t g = 0; g < groups; ++g)
        for (double& v : mean[g]) v /= totals[g];
    gradient.assign(d, 0);
    information.assign(d, std::vector<double>(d));
    std::vector<double> centred(d);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t k = 0; k < d; ++k) centred[k] = rows[i].x[f.factors[k]] - mean[rows[i].group][k];
        for (std::size_t k = 0; k < d; ++k) {
            gradient[k] += (rows[i].observed - m.mu[i]) * centred[k] / rows[i].unit;
            for (std::size_t j = 0; j < d; ++j) information[k][j] += m.mu[i] * centred[k] * centred[j] / rows[i].unit;
        }
    }
    for (std::size_t k = 0; k < d; ++k) information[k][k] += 1e-9;
}

/// Diagonal element k of the inverse.
double inverse_at(const Matrix& a, std::size_t k) {
    std::vector<double> unit(a.size());
    unit[k] = 1;
    const auto column = solved(a, unit, 1e-12);
    return column ? (*column)[k] : 1e300;
}

}  // namespace

Fit fit(std::span<const Row> rows, std::size_t groups, std::vector<std::size_t> factors) {
    Fit f;
    f.factors = std::move(factors);
    f.exponents.resize(f.factors.size());
    f.errors.resize(f.factors.size());
    Model m = model_of(rows, groups, f);
    std::vector<double> gradient;
    Matrix information;
    for (int step = 0; step < most_steps && !f.factors.empty(); ++step) {
        derivatives(rows, groups, f, m, gradient, information);
        const auto correction = solved(information, gradient, 1e-12);
        if (!correction) break;
        double size = 0;
        for (std::size_t k = 0; k < correction->size(); ++k) {
            const double d = std::clamp((*correction)[k], -1.0, 1.0);
            f.exponents[k] += d;
            size += std::fabs(d);
        }
        m = model_of(rows, groups, f);
        if (size < 1e-8) break;
    }
    if (!f.factors.empty()) derivatives(rows, groups, f, m, gradient, information);
    for (std::size_t k = 0; k < f.factors.size(); ++k) f.errors[k] = std::sqrt(inverse_at(information, k));
    f.constants = m.constants;
    f.likelihood = m.likelihood;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double residual = rows[i].observed - m.mu[i], scale = m.mu[i] / rows[i].expected;
        f.misfit += residual * residual / (rows[i].unit * m.mu[i] + rows[i].variance * scale * scale + 1e-300);
    }
    f.misfit /= std::max<double>(static_cast<double>(rows.size()) - static_cast<double>(f.factors.size() + groups), 1);
    return f;
}

Fit select(std::span<const Row> rows, std::size_t groups, std::size_t factors, std::size_t largest_count) {
    Fit best = fit(rows, groups, {});
    while (best.factors.size() < largest_count) {
        Fit next = best;
        for (std::size_t k = 0; k < factors; ++k) {
            if (std::ranges::find(best.factors, k) != best.factors.end()) continue;
            std::vector<std::size_t> factor_indices = best.factors;
            factor_indices.push_back(k);
            Fit f = fit(rows, groups, std::move(factor_indices));
            if (std::isfinite(f.likelihood) && f.likelihood > next.likelihood) next = std::move(f);
        }
        if (next.likelihood - best.likelihood < math::log(static_cast<double>(rows.size())) / 2 + least_lead) break;
        best = std::move(next);
        if (best.misfit < 1.05) break;
    }
    return best;
}

// ---- Rows of the regression are the leaves in which p expects a draw; the draws have no influence on this choice.

namespace {

constexpr std::size_t most_factors = 3;  // that are tested further

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
        const CheckAt& c = *places[g].check;
        const double n = c.observations.independent;
        double h = 0, h2 = 0;
        for (const LeafIntegral& l : c.integrals.leaves) {
            h += l.bridge.value;
            h2 += l.second;
        }
        if (!(h > 0)) continue;
        for (std::size_t l = 0; l < c.integrals.leaves.size(); ++l) {
            const LeafIntegral& leaf = c.integrals.leaves[l];
            if (leaf.bridge.value * n < 1) continue;
            Row r{.group = g,
                .observed = c.observations.leaves[l],
                .expected = leaf.bridge.value * n,
                .variance = leaf.bridge.variance * n * n,
                .unit = h2 / h,
                .x = {}};
            const Leaf& tree_leaf = c.plan->tree.leaves()[l];
            for (const Factor& f : factors)
                r.x.push_back(math::log(average(f, places[g].check_case->wo, c.plan->tree.rect(tree_leaf)) + 1e-12));
            r.x.push_back(math::log(tree_leaf.q));
            rows.push_back(std::move(r));
        }
    }
    return rows;
}

/// The simple exponent that agrees with a fitted one: 1 or -1 before 1/2, 2 and others; 0 if there is none.
double simple_of(double b, double error) {
    const double tolerance = std::max(3 * error, simple_tolerance);
    if (std::fabs(b) < 4 * error) return 0;
    for (double exponent : {1.0, 2.0, 0.5, 1.5, 3.0})
        if (std::fabs(std::fabs(b) - exponent) < tolerance) return b > 0 ? exponent : -exponent;
    return 0;
}

double power_of(double x, double b) { return x > 0 ? math::exp(b * math::log(x)) : 0; }

/// The known number next to a constant: 1, or the usual constant of the factor.
double known_constant(double constant, double usual, double b) {
    for (double candidate : {1.0, power_of(usual, b)})
        if (std::fabs(constant / candidate - 1) < 0.02) return candidate;
    return constant;
}

/// Sets the gain from the log likelihood gained by a factor over constants alone, and that of the constants from the
/// masses.
void set_gain(Hypothesis& h, double likelihood, std::span<const Place> places) {
    double draws = 0, mass_gain = 0;
    for (const Place& place : places) {
        const double n = place.check->observations.independent, ratio = std::max(mass_ratio(*place.check).ratio, 1e-12);
        draws += n;
        mass_gain += n * (ratio - 1 - math::log(ratio));
    }
    h.gain = (likelihood + mass_gain) / draws;
    h.draws = draws;
    h.error = std::sqrt(2 * std::max(likelihood, 1.0)) / draws;
}

}  // namespace

Hypothesis times(const Factor& f, double b) {
    Hypothesis h;
    h.name = f.name;
    h.has_free_constant = true;
    h.density = [f, b](const SamplerAdapter& s, int technique, std::span<const Pair> pairs, std::span<double> out) {
        s.exact_pdf(technique, pairs, out);
        for (std::size_t i = 0; i < pairs.size(); ++i)
            if (out[i] > 0) out[i] *= power_of(f.value(pairs[i].wo, pairs[i].wi), b);
    };
    return h;
}

std::vector<FactorHypothesis> factor_hypotheses(std::span<const Place> places) {
    const std::vector<Factor> factors = factors_for(places[0].traits, places[0].check_case->light);
    const std::vector<Row> rows = rows_of(places, factors);
    std::vector<FactorHypothesis> out;
    if (rows.size() < 32) return out;
    const Fit constant_fit = fit(rows, places.size(), {});
    std::vector<std::pair<Fit, std::size_t>> fits;
    for (std::size_t k = 0; k < factors.size(); ++k) {
        Fit f = fit(rows, places.size(), {k});
        const double b = f.exponents[0];
        const bool is_possible =
            factors[k].any_exponent ? std::fabs(b) > 5 * f.errors[0] : simple_of(b, f.errors[0]) != 0;
        if (!std::isfinite(f.likelihood) || !(f.errors[0] < 0.2) || !is_possible) continue;
        fits.emplace_back(std::move(f), k);
    }
    std::ranges::sort(fits, std::greater<>(), [](const auto& one) { return one.first.likelihood; });
    if (fits.size() > most_factors) fits.resize(most_factors);
    for (const auto& [f, k] : fits) {
        const double b = f.exponents[0], exponent = factors[k].any_exponent ? b : simple_of(b, f.errors[0]);
        FactorHypothesis candidate{.hypothesis = times(factors[k], exponent),
            .name = factors[k].name,
            .exponent = exponent,
            .fitted_exponent = b,
            .error = f.errors[0],
            .usual_constant = factors[k].usual_constant};
        for (double c : f.constants)
            candidate.hypothesis.constants.push_back(known_constant(c, factors[k].usual_constant, exponent));
        set_gain(candidate.hypothesis, f.likelihood - constant_fit.likelihood, places);
        if (candidate.hypothesis.helps()) out.push_back(std::move(candidate));
    }
    return out;
}

std::optional<FactorHypothesis> power_hypothesis(std::span<const Place> places) {
    // The density on the chart of an infinite line is not the one over the line, and neither are its powers.
    if (const DomainChart* domain = places[0].traits.domain.get(); domain && domain->domain().is_infinite()) return {};
    const std::vector<Row> rows = rows_of(places, {});
    if (rows.size() < 32) return {};
    const Fit f = fit(rows, places.size(), {0});
    const double b = f.exponents[0];
    if (!(std::fabs(b) > std::max(least_power, 4 * f.errors[0])) || !(std::fabs(b) < largest_power)) return {};
    FactorHypothesis out{
        .hypothesis = {}, .name = "p", .exponent = b, .fitted_exponent = b, .error = f.errors[0], .usual_constant = 1};
    out.hypothesis.name = "p";
    out.hypothesis.has_free_constant = true;
    out.hypothesis.constants = f.constants;
    out.hypothesis.density = [b](const SamplerAdapter& s, int technique, std::span<const Pair> pairs,
                                 std::span<double> to) {
        s.exact_pdf(technique, pairs, to);
        for (double& v : to) v = v > 0 ? v * power_of(v, b) : 0;
    };
    set_gain(out.hypothesis, f.likelihood - fit(rows, places.size(), {}).likelihood, places);
    return out.hypothesis.helps() ? std::optional(out) : std::nullopt;
}

}  // namespace crescent::check
