// Candidate factors by which a density may be off, as functions of the direction, and their names in a report.
#include "check/explain/causes.h"

#include <cmath>
#include <fmt/format.h>
#include <functional>

#include "check/constants.h"
#include "check/explain/regression.h"

namespace crescent::check {

namespace {

/// A candidate: its value for given directions, positive. p: at that direction, by the sampler.
struct Factor {
    const char* name;
    std::function<double(Vec3d wo, Vec3d wi)> value;
};

Vec3d half_of(Vec3d a, Vec3d b) {
    const Vec3d h = a + b;
    return h * (1 / std::sqrt(dot(h, h) + 1e-300));
}

const std::vector<Factor>& factors() {
    static const std::vector<Factor> all = {
        {"cos theta_i", [](Vec3d, Vec3d i) { return std::fabs(i.z); }},
        {"sin theta_i", [](Vec3d, Vec3d i) { return std::sqrt(i.x * i.x + i.y * i.y); }},
        {"w_o.m", [](Vec3d o, Vec3d i) { return std::fabs(dot(half_of(o, i), o)); }},
        {"n.m", [](Vec3d o, Vec3d i) { return std::fabs(half_of(o, i).z); }},
        {"p", nullptr},
        {"the side of the surface", [](Vec3d, Vec3d i) { return i.z < 0 ? std::exp(1.0) : 1.0; }},
        {"e^x", [](Vec3d, Vec3d i) { return math::exp(i.x); }},
        {"e^y", [](Vec3d, Vec3d i) { return math::exp(i.y); }},
        {"e^z", [](Vec3d, Vec3d i) { return math::exp(i.z); }},
    };
    return all;
}
constexpr std::size_t nameable = 4;  // the first of them

/// Rows of one w_o: leaves in which the claim expects a draw, chosen by the claim alone.
void add_rows(const CheckAt& c, Vec3d wo, std::size_t group, std::vector<Row>& rows) {
    const double n = c.observations.independent;
    double h = 0, h2 = 0;
    for (const LeafIntegral& l : c.integrals.leaves) h += l.bridge.value, h2 += l.second;
    if (!(h > 0)) return;
    for (std::size_t l = 0; l < c.integrals.leaves.size(); ++l) {
        const LeafIntegral& leaf = c.integrals.leaves[l];
        if (leaf.bridge.value * n < 1) continue;
        const ChartRect& rect = c.plan->tree.rect(c.plan->tree.leaves()[l]);
        Row r{group, c.observations.leaves[l], leaf.bridge.value * n, leaf.bridge.variance * n * n, h2 / h, {}};
        for (const Factor& f : factors()) {
            double value = 0;
            for (int j = 0; j < 9 && f.value; ++j)
                value += f.value(wo, from_chart(rect.at((1 + 2 * (j % 3)) / 6.0, (1 + 2 * (j / 3)) / 6.0))) / 9;
            if (!f.value) value = c.plan->tree.leaves()[l].q;
            r.x.push_back(math::log(value + 1e-12));
        }
        rows.push_back(std::move(r));
    }
}

double nearest_half(double x) { return std::round(2 * x) / 2; }

/// p is the same multiple of what is drawn at every w_o.
std::optional<Cause> constant_of(const CheckOutcome& outcome) {
    double low = 1e300, high = 0, sum = 0, count = 0, sd = 0;
    for (const auto& techniques : outcome.at)
        for (const CheckAt& c : techniques) {
            const double drawn = c.observations.sums[mass].sum / std::max(c.observations.independent, 1.0);
            const double by = c.integrals.sums[mass].value / std::max(drawn, 1e-12);
            low = std::min(low, by), high = std::max(high, by), sum += by, ++count;
            sd = std::max(sd, std::sqrt(c.integrals.sums[mass].variance) / std::max(drawn, 1e-12));
        }
    const double value = sum / std::max(count, 1.0), known = std::max(3e-3 * value, 4 * sd);
    if (!(count > 0) || high - low > 2 * known || std::fabs(value - 1) < known / 10 || sd > 0.05) return {};
    return Cause{
        "constant", value, sd, fmt::format("p is {:.5g} times what is drawn: a constant factor explains it.", value)};
}

}  // namespace

std::optional<Cause> cause_of(std::span<const Trial> trials, const CheckOutcome& outcome) {
    std::vector<Row> rows;
    std::size_t groups = 0;
    for (std::size_t k = 0; k < outcome.at.size(); ++k)
        for (const CheckAt& c : outcome.at[k])
            if (c.plan && c.plan->drawn > 0 && groups < 16) add_rows(c, trials[outcome.trials[k]].wo, groups++, rows);
    if (rows.size() < 64) return {};
    const double before = misfit_of(rows);
    const Fit even = fit(rows, groups, {});
    const auto explains = [&](double misfit) { return misfit < 1.1 || misfit - 1 < 0.02 * (before - 1); };
    if (explains(even.misfit)) return constant_of(outcome);
    const Fit best = select(rows, groups, factors().size(), 2);
    if (best.factors.size() != 1 || !explains(best.misfit)) return {};
    const std::size_t k = best.factors[0];
    const double b = best.exponents[0], simple = nearest_half(b);
    if (k >= nameable || simple == 0 || std::fabs(b - simple) > std::max(3 * best.errors[0], 0.03)) return {};
    const char* name = factors()[k].name;
    return Cause{name, b, best.errors[0],
        fmt::format("Draws follow p times {}^{:.3g} (+- {:.2g}): {} {} in the pdf.", name, b, best.errors[0], name,
            b > 0 ? "is missing" : "is there once too often")};
}

}  // namespace crescent::check
