// Uses the counts and densities of the leaves.
#include "check/explain/spread.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

#include "check/decide/small_tests.h"
#include "check/explain/causes.h"
#include "check/explain/constants.h"
#include "output/format.h"

namespace crescent::check {

namespace {

constexpr int share_halvings = 24;

bool in_domain(const ChartRect& rect, bool covers_sphere) { return covers_sphere || rect.t0 < 1; }

/// Solid angle of the leaves in which p is positive.
double support_of(const Place& place, bool covers_sphere) {
    double sum = 0;
    const Tree& tree = place.check->plan->tree;
    for (const Leaf& leaf : tree.leaves())
        if (leaf.has_mass && in_domain(tree.rect(leaf), covers_sphere)) sum += tree.rect(leaf).area();
    return sum;
}

/// By (1) with h ln p, the test function that a uniform part changes most: its mean is linear in the share. Used if it
/// is more precise than the given share and agrees with it.
void refine_by_slope(std::span<const Place> places, double even_density, double& share, double& error) {
    double sum = 0, weights = 0;
    for (const Place& place : places) {
        const Observations& o = place.check->observations;
        const Estimate& claim = place.check->integrals.sums[slope];
        const double even_mean = place.check->integrals.uniform_sums[slope] * even_density,
                     n = std::max(o.independent, 1.0);
        double mean = o.sums[slope].sum / n, variance = o.sums[slope].square / (n * n);
        if (o.scrambled > 0) {
            Replicates y;
            for (std::size_t k = 0; k < y.size(); ++k) y[k] = o.by_set[slope][k] * replicate_sets / o.scrambled;
            const ReplicateMean<Replicates> sets(y, 0);
            mean = sets.mean;
            variance = sets.variance;
        }
        const double gap = even_mean - claim.value;
        if (!(std::fabs(gap) > 0)) return;
        const double weight = gap * gap / (variance + claim.variance + 1e-300);
        sum += weight * (mean - claim.value) / gap;
        weights += weight;
    }
    if (!(weights > 0) || 1 / std::sqrt(weights) > error || std::fabs(sum / weights - share) > 5 * error) return;
    share = sum / weights;
    error = 1 / std::sqrt(weights);
}

/// The share of a uniform density in a mixture with the q of the leaves, of largest likelihood. The likelihood is that
/// of Poisson counts, which is concave in the share. If draws where p is 0 count as no sample, the uniform part is
/// visible only where p is positive.
Leak fitted_leak(std::span<const Place> places, bool covers_sphere) {
    const double even_density = 1 / (covers_sphere ? 2 * two_pi : two_pi);
    Leak out;
    out.covers_sphere = covers_sphere;
    const bool counts_zero = places[0].draws_at_zero();
    struct Derivatives {
        double first = 0, second = 0;
    };
    const auto derivatives = [&](double share) {
        Derivatives d;
        for (const Place& place : places) {
            const Tree& tree = place.check->plan->tree;
            d.first -= place.check->observations.independent *
                (counts_zero ? 0 : even_density * support_of(place, covers_sphere) - 1);
            for (std::size_t l = 0; l < tree.leaves().size(); ++l) {
                const double count = place.check->observations.counts[l];
                if (!(count > 0)) continue;
                const double u = in_domain(tree.rect(tree.leaves()[l]), covers_sphere) ? even_density : 0;
                const double p = tree.leaves()[l].has_mass ? tree.leaves()[l].q : 0;
                const double change = (u - p) / ((1 - share) * p + share * u + 1e-300);
                d.first += count * change;
                d.second -= count * change * change;
            }
        }
        return d;
    };
    double low = 0, high = 1;
    for (int step = 0; step < share_halvings; ++step) {
        const double middle = (low + high) / 2;
        (derivatives(middle).first > 0 ? low : high) = middle;
    }
    double share = low;
    const double information = -derivatives(share).second;
    out.error = information > 0 ? 1 / std::sqrt(information) : 1;
    refine_by_slope(places, even_density, share, out.error);
    out.share = share;
    out.hypothesis.name = "leak";
    out.hypothesis.density = [share, even_density, covers_sphere, counts_zero](const SamplerAdapter& s, int technique,
                                 std::span<const Pair> pairs, std::span<double> to) {
        s.exact_pdf(technique, pairs, to);
        for (std::size_t i = 0; i < pairs.size(); ++i)
            if (counts_zero || to[i] > 0)
                to[i] = (1 - share) * to[i] + (covers_sphere || pairs[i].wi.z > 0 ? share * even_density : 0);
    };
    return out;
}

/// The masses of p and of the draws in leaves without draws, where p expects some, and in leaves with draws.
struct Reach {
    double unreached_mass = 0, reached_mass = 0, drawn_mass = 0, misfit = 0, leaves = 0;
    double ratio = 1;  // draws over p in leaves with draws
};
Reach reach_at(const CheckAt& c) {
    Reach out;
    const double n = c.observations.independent;
    double h_drawn = 0, h_claimed = 0;
    for (std::size_t l = 0; l < c.integrals.leaves.size(); ++l) {
        const LeafIntegral& leaf = c.integrals.leaves[l];
        if (c.observations.counts[l] > 0) {
            h_drawn += c.observations.leaves[l] / n;
            h_claimed += leaf.bridge.value;
        }
    }
    const double scale = out.ratio = h_claimed > 0 ? h_drawn / h_claimed : 1;
    for (std::size_t l = 0; l < c.integrals.leaves.size(); ++l) {
        const LeafIntegral& leaf = c.integrals.leaves[l];
        const Leaf& tree_leaf = c.plan->tree.leaves()[l];
        const double p = tree_leaf.has_mass ? tree_leaf.q * c.plan->tree.rect(tree_leaf).area() : 0;
        const double expected = leaf.bridge.value * n * scale;
        if (!(c.observations.counts[l] > 0)) {
            if (expected > expected_unreached || leaf.bridge.value * n > expected_unreached) out.unreached_mass += p;
            continue;
        }
        out.reached_mass += p;
        out.drawn_mass += c.observations.counts[l] / n;
        if (expected < 20) continue;
        const double unit = leaf.second / std::max(leaf.bridge.value, 1e-300);
        const double residual = c.observations.leaves[l] - expected;
        out.misfit += residual * residual / (unit * expected + leaf.bridge.variance * n * n * scale * scale + 1e-300);
        ++out.leaves;
    }
    return out;
}

}  // namespace

bool Leak::is_clear() const { return share > clear_leak * error; }

std::vector<Leak> leak_hypotheses(std::span<const Place> places) {
    std::vector<Leak> out;
    const DomainChart* domain = places[0].traits.domain.get();
    if (domain && domain->domain().is_infinite()) return out;
    for (bool covers_sphere : {true, false}) {
        if (!covers_sphere && domain) continue;
        Leak leak = fitted_leak(places, covers_sphere);
        if (leak.share < least_leak || leak.share > 0.9) continue;
        bool mass_agrees = true;
        for (const Place& place : places) {
            leak.hypothesis.masses.push_back(1 - leak.share +
                leak.share *
                    (place.draws_at_zero() ? 1
                                           : support_of(place, covers_sphere) / ((covers_sphere ? 2 : 1) * two_pi)) /
                    mass_ratio(*place.check).claimed_mass);
            const MassRatio m = mass_ratio(*place.check);
            mass_agrees = mass_agrees &&
                std::fabs(leak.hypothesis.masses.back() * m.ratio - 1) < 5 * (m.error / m.ratio + leak.error);
        }
        if (!mass_agrees) continue;
        score(leak.hypothesis, places);
        if (leak.hypothesis.gain > 0) out.push_back(std::move(leak));
    }
    return out;
}

std::string leak_sentence(const Leak& leak, const Traits& traits) {
    return fmt::format("{:.3g} % +- {:.2g} % of the draws are spread evenly over the {}, which p does not have.",
        100 * leak.share, 196 * leak.error,
        traits.domain            ? "domain"
            : leak.covers_sphere ? "sphere"
                                 : "upper half");
}

std::optional<Cause> delta_cause(std::span<const Place> places) {
    for (const Place& place : places) {
        std::vector<Vec3d> w = place.w;
        const DomainChart* domain = place.traits.domain.get();
        if (domain && domain->is_discrete()) continue;
        if (domain && domain->is_line())  // spread over the azimuth
            for (Vec3d& v : w) v = from_chart({to_chart(v).t, 0});
        std::ranges::sort(w, {}, [](Vec3d v) { return std::tuple(v.x, v.y, v.z); });
        std::size_t longest = 0, first = 0;
        for (std::size_t i = 0, end = 0; i < w.size(); i = end) {
            for (end = i + 1; end < w.size() && length(w[end] - w[i]) < one_point;) ++end;
            if (end - i > longest) {
                longest = end - i;
                first = i;
            }
        }
        const double share = static_cast<double>(longest) / place.draw_count,
                     half_width = 1.96 * std::sqrt(share * (1 - share) / place.draw_count);
        if (share < least_delta) continue;
        return Cause{.factor = "delta",
            .exponent = share,
            .error = half_width / 1.96,
            .text = fmt::format("{} of the draws have one {}, {}{}, for any u. A density does not draw it{}.",
                share > every_draw ? "All" : percent_with_error(share, half_width), domain ? "point" : "direction",
                place_text(place.traits, w[first]), place.where(),
                domain ? "" : ": if it is a delta part, the sampler must declare it (delta) with its probability")};
    }
    return {};
}

std::optional<Cause> curve_cause(std::span<const Place> places) {
    for (const Place& place : places) {
        Source source = place.source();
        const StreamKey key = place.key(11, Purpose::corners, 1);
        const std::vector<int> unused = numbers_without_effect(source, key);
        if (unused.empty() || source.traits.numbers - static_cast<int>(unused.size()) > 1) continue;
        return Cause{.factor = "curve",
            .exponent = 0,
            .error = 0,
            .text = fmt::format("All draws lie on a curve: u{} has no effect on them.", unused.front() + 1)};
    }
    return {};
}

std::optional<Cause> unreached_cause(std::span<const Place> places) {
    const Place* worst_place = nullptr;
    Reach worst_reach;
    for (const Place& place : places) {
        const Reach r = reach_at(*place.check);
        if (!(r.unreached_mass > least_unreached * (r.unreached_mass + r.reached_mass)) ||
            std::fabs(r.ratio - 1) > elsewhere_tolerance)
            continue;
        if (r.leaves > 0 && r.misfit / r.leaves > 1.5 && r.unreached_mass < r.reached_mass)
            continue;  // more than the unreached part is wrong
        if (!worst_place || r.unreached_mass > worst_reach.unreached_mass) {
            worst_place = &place;
            worst_reach = r;
        }
    }
    if (!worst_place) return {};
    const Integrals& integrals = worst_place->check->integrals;
    const double share = worst_reach.unreached_mass / (worst_reach.unreached_mass + worst_reach.reached_mass),
                 total = integrals.sums[mass].value;
    const bool is_partly_unresolved = integrals.unresolved.value > 0;  // it integrates to more, perhaps to infinity
    const std::string part = is_partly_unresolved
        ? fmt::format("{:.3g} % of it where its points resolve it", 100 * share)
        : fmt::format("{:.3g} of the {:.3g} that it integrates to", total * share, total);
    return Cause{.factor = "unreached",
        .exponent = total * share,
        .error = 0,
        .text = fmt::format(
            "p is positive where no draw falls: {}{}. Combined with another sampler by MIS the image is too dark.",
            part, worst_place->where())};
}

}  // namespace crescent::check
