// Poisson regression by Newton's method: the ratio of observed to expected draws of a leaf, explained by the logarithms
// of candidate factors. Factors are added one at a time, the one with the largest gain in likelihood first.
#include "check/explain/hypothesis.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "math/least_squares.h"

namespace crescent::check {

namespace {

constexpr double least_gain = 8;  // of the log likelihood, in units of one draw: e^-8 for each factor tried
constexpr double largest = 20;    // exponents of e
constexpr int most_steps = 40;

/// Means and constants for given exponents.
struct Model {
    std::vector<double> mu, constants;
    double likelihood = 0;
};

Model model_of(std::span<const Row> rows, std::size_t groups, const Fit& f) {
    Model m;
    m.mu.resize(rows.size());
    std::vector<double> drawn(groups), claimed(groups);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        double eta = 0;
        for (std::size_t k = 0; k < f.factors.size(); ++k) eta += f.exponents[k] * rows[i].x[f.factors[k]];
        m.mu[i] = rows[i].expected * math::exp(std::clamp(eta, -largest, largest));
        drawn[rows[i].group] += rows[i].observed, claimed[rows[i].group] += m.mu[i];
    }
    for (std::size_t g = 0; g < groups; ++g) m.constants.push_back(claimed[g] > 0 ? drawn[g] / claimed[g] : 1);
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
    std::vector<double> all(groups, 1e-300);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        all[rows[i].group] += m.mu[i];
        for (std::size_t k = 0; k < d; ++k) mean[rows[i].group][k] += m.mu[i] * rows[i].x[f.factors[k]];
    }
    for (std::size_t g = 0; g < groups; ++g)
        for (double& v : mean[g]) v /= all[g];
    gradient.assign(d, 0), information.assign(d, std::vector<double>(d));
    std::vector<double> off(d);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t k = 0; k < d; ++k) off[k] = rows[i].x[f.factors[k]] - mean[rows[i].group][k];
        for (std::size_t k = 0; k < d; ++k) {
            gradient[k] += (rows[i].observed - m.mu[i]) * off[k] / rows[i].unit;
            for (std::size_t j = 0; j < d; ++j) information[k][j] += m.mu[i] * off[k] * off[j] / rows[i].unit;
        }
    }
    for (std::size_t k = 0; k < d; ++k) information[k][k] += 1e-9;
}

/// Diagonal element k of the inverse.
double inverse_at(const Matrix& a, std::size_t k) {
    std::vector<double> unit(a.size());
    unit[k] = 1;
    const auto column = statistics::solved(a, unit, 1e-12);
    return column ? (*column)[k] : 1e300;
}

}  // namespace

double misfit_of(std::span<const Row> rows) {
    double sum = 0;
    for (const Row& r : rows)
        sum += (r.observed - r.expected) * (r.observed - r.expected) / (r.unit * r.expected + r.variance);
    return rows.empty() ? 1 : sum / static_cast<double>(rows.size());
}

Fit fit(std::span<const Row> rows, std::size_t groups, std::vector<std::size_t> factors) {
    Fit f;
    f.factors = std::move(factors);
    f.exponents.resize(f.factors.size()), f.errors.resize(f.factors.size());
    Model m = model_of(rows, groups, f);
    std::vector<double> gradient;
    Matrix information;
    for (int step = 0; step < most_steps && !f.factors.empty(); ++step) {
        derivatives(rows, groups, f, m, gradient, information);
        const auto by = statistics::solved(information, gradient, 1e-12);
        if (!by) break;
        double size = 0;
        for (std::size_t k = 0; k < by->size(); ++k) {
            const double d = std::clamp((*by)[k], -1.0, 1.0);
            f.exponents[k] += d, size += std::fabs(d);
        }
        m = model_of(rows, groups, f);
        if (size < 1e-8) break;
    }
    if (!f.factors.empty()) derivatives(rows, groups, f, m, gradient, information);
    for (std::size_t k = 0; k < f.factors.size(); ++k) f.errors[k] = std::sqrt(inverse_at(information, k));
    f.constants = m.constants, f.likelihood = m.likelihood;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double off = rows[i].observed - m.mu[i], by = m.mu[i] / rows[i].expected;
        f.misfit += off * off / (rows[i].unit * m.mu[i] + rows[i].variance * by * by + 1e-300);
    }
    f.misfit /= std::max<double>(static_cast<double>(rows.size()) - static_cast<double>(f.factors.size() + groups), 1);
    return f;
}

Fit select(std::span<const Row> rows, std::size_t groups, std::size_t factors, std::size_t most) {
    Fit best = fit(rows, groups, {});
    while (best.factors.size() < most) {
        Fit next = best;
        for (std::size_t k = 0; k < factors; ++k) {
            if (std::ranges::find(best.factors, k) != best.factors.end()) continue;
            std::vector<std::size_t> with = best.factors;
            with.push_back(k);
            Fit f = fit(rows, groups, std::move(with));
            if (std::isfinite(f.likelihood) && f.likelihood > next.likelihood) next = std::move(f);
        }
        if (next.likelihood - best.likelihood < math::log(static_cast<double>(rows.size())) / 2 + least_gain) break;
        best = std::move(next);
        if (best.misfit < 1.05) break;
    }
    return best;
}

}  // namespace crescent::check
