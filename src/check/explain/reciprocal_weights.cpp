// Causes for random weights W that estimate 1/p. With W times a candidate factor the draws must give the integral of h
// in every region: then the factor is the cause. The draws and their points are fresh.
#include "check/explain/reciprocal_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "check/decide/check_sampler.h"
#include "check/estimate/source.h"
#include "check/explain/causes.h"
#include "check/explain/constants.h"
#include "check/explain/factors.h"
#include "check/sources/neighbours.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent::check {

namespace {

/// At one direction: the target of the receiver over q, and sums over it and its neighbours of their targets there over
/// the receiver's.
struct WeightPlace {
    Vec3d wi;
    double target = 1;
    double surfaces = 1, target_count = 1, ratios = 1, squared_ratios = 1, reciprocal_ratios = 1;
};

/// A factor by which W may be off.
struct WeightFactor {
    const char* name;
    double (*value)(const WeightPlace& place);
    const char* corrected_weight;  // W without it
    const char* fault;             // in words
};
constexpr const char* source_in_weight =
    "the weight by which a neighbour's sample is resampled has the target of its source surface, not that of the "
    "receiver";
constexpr WeightFactor weight_factors[] = {
    {"constant", [](const WeightPlace&) { return 1.0; }, "", ""},
    {"target", [](const WeightPlace& place) { return place.target; }, "W / target",
        "W is not divided by the target of the direction that is kept"},
    {"1/target", [](const WeightPlace& place) { return 1 / place.target; }, "W x target",
        "W is divided twice by the target of the direction that is kept"},
    {"cos theta_i", [](const WeightPlace& place) { return std::fabs(place.wi.z); }, "W / cos theta_i",
        "W has cos theta_i once too often"},
    {"1/cos theta_i", [](const WeightPlace& place) { return 1 / std::max(std::fabs(place.wi.z), 1e-6); },
        "W x cos theta_i", "W lacks a factor cos theta_i"},
    {"1/M", [](const WeightPlace& place) { return place.target_count / place.surfaces; }, "W x M / Z",
        "M counts all surfaces, also those whose target is 0 at w_i (1/M bias); MIS weights, or Z, the number of those "
        "that can draw w_i, are unbiased"},
    {"target of the source in the resampling weight",
        [](const WeightPlace& place) { return place.ratios / place.surfaces; }, "the receiver's target",
        source_in_weight},
    {"target of the source in the balanced resampling weight",
        [](const WeightPlace& place) { return place.squared_ratios / place.ratios; }, "the receiver's target",
        source_in_weight},
    {"target of the source in W", [](const WeightPlace& place) { return place.reciprocal_ratios / place.surfaces; },
        "the receiver's target",
        "W is divided by the target of the source surface of the kept sample, not by that of the receiver"},
};
constexpr std::size_t constant_index = 0;          // its index
constexpr std::size_t single_surface_factors = 5;  // factors that do not depend on neighbours; these are the first

constexpr std::size_t height_parts = 8, azimuth_parts = 4, target_parts = 2,
                      regions = height_parts * azimuth_parts * target_parts;
constexpr std::uint32_t draws_of_weights = 1u << 18, points_of_target = 1u << 16, batch = 1u << 14;
constexpr double golden_ratio = 0.618033988749894848;

std::size_t region_of(Vec3d w, double h) {
    const auto part = [](double share, std::size_t count) {
        return std::min(static_cast<std::size_t>(std::max(share, 0.0) * static_cast<double>(count)), count - 1);
    };
    const ChartPoint place = to_chart(w);
    return (part(place.t / 2, height_parts) * azimuth_parts + part(place.phi / two_pi, azimuth_parts)) * target_parts +
        part(h, target_parts);
}

struct RegionSum {
    double sum = 0, squares = 0;
    void add(double x) {
        sum += x;
        squares += x * x;
    }
};
using RegionSums = std::array<RegionSum, regions>;

/// h W over the fresh draws of one w_o, and h over points of the whole sphere.
struct ReservoirSums {
    std::array<RegionSums, std::size(weight_factors)> weight_sums{};  // of W over each factor
    std::array<double, regions> integral{}, error{};
    double draws = 0, empty_draws = 0;  // draws, and those without a weight
    /// Shares of directions whose target is above 0: uniform over the sphere, over the hemisphere, by the cosine.
    std::array<double, 3> target_shares{};
};

/// Sets what depends on the neighbours: identity shifts, so that w_i is one direction for all of them.
void add_neighbours(const Source& source, std::span<WeightPlace> places) {
    const std::vector<Neighbour> neighbours = neighbours_of(source.wo, source.traits.neighbours);
    const auto targets = [&](auto&& pair_at) {
        std::vector<Pair> pairs;
        for (const WeightPlace& place : places) pairs.push_back(pair_at(place.wi));
        std::vector<double> out(pairs.size());
        source.adapter.target(pairs, out);
        return out;
    };
    if (neighbours.empty()) return;
    const std::vector<double> receiver_targets = targets([&](Vec3d wi) { return Pair{source.wo, wi}; });
    for (const Neighbour& neighbour : neighbours) {
        const Vec3d wo = to_local(neighbour, neighbour.wo);
        const std::vector<double> neighbour_targets =
            targets([&](Vec3d wi) { return Pair{wo, to_local(neighbour, wi)}; });
        for (std::size_t i = 0; i < places.size(); ++i) {
            const double ratio =
                receiver_targets[i] > 0 ? neighbour.light * neighbour_targets[i] / receiver_targets[i] : 0;
            ++places[i].surfaces;
            if (!(ratio > 0)) continue;
            ++places[i].target_count;
            places[i].ratios += ratio;
            places[i].squared_ratios += ratio * ratio;
            places[i].reciprocal_ratios += 1 / ratio;
        }
    }
}

/// Factors of merging are none without it.
std::size_t factor_count(const Traits& traits) {
    return traits.neighbours > 0 ? std::size(weight_factors) : single_surface_factors;
}

void add_draws(Source& source, const StreamKey& key, ReservoirSums& out) {
    std::vector<Draw> draws(batch);
    std::vector<Vec3d> w;
    std::vector<double> weights;
    std::vector<Vec3d> h;
    for (std::uint32_t i = 0; i < draws_of_weights; i += batch) {
        StreamKey part = key;
        part.part = static_cast<std::uint16_t>(i / batch);
        source.draw(first_numbers(part, batch, source.traits), draws);
        w.clear();
        weights.clear();
        for (const Draw& d : draws)
            if (d.pdf > 0 && d.weight && *d.weight > 0 && std::isfinite(*d.weight + dot(d.wi, d.wi))) {
                w.push_back(d.wi);
                weights.push_back(*d.weight);
            }
        h.resize(w.size());
        source.f_cos(w, h);
        out.draws += batch;
        out.empty_draws += static_cast<double>(batch - w.size());
        std::vector<WeightPlace> places(w.size());
        for (std::size_t k = 0; k < w.size(); ++k) {
            places[k].wi = w[k];
            places[k].target = h[k].x / (1 - h[k].x);
        }
        add_neighbours(source, places);
        for (std::size_t k = 0; k < w.size(); ++k) {
            if (!(h[k].x > 0 && h[k].x < 1)) continue;
            const std::size_t region = region_of(w[k], h[k].x);
            for (std::size_t f = 0; f < factor_count(source.traits); ++f)
                out.weight_sums[f][region].add(weights[k] / weight_factors[f].value(places[k]));
        }
    }
}

/// A spiral by the golden ratio: the error of a region with n of N points is below n^(1/4) / N of its area.
void add_points(Source& source, ReservoirSums& out) {
    std::vector<Vec3d> w(points_of_target), h(points_of_target);
    for (std::uint32_t i = 0; i < points_of_target; ++i) {
        const double turns = golden_ratio * i;
        w[i] = from_chart({2 * (i + 0.5) / points_of_target, two_pi * (turns - std::floor(turns))});
    }
    source.f_cos(w, h);
    const double area = 2 * two_pi / points_of_target;
    std::array<double, regions> counts{};
    std::array<double, 3> totals{};
    for (std::size_t i = 0; i < w.size(); ++i) {
        const double densities[] = {1, w[i].z > 0 ? 1.0 : 0.0, std::max(w[i].z, 0.0)};  // up to a constant
        for (std::size_t k = 0; k < totals.size(); ++k) {
            totals[k] += densities[k];
            out.target_shares[k] += h[i].x > 0 ? densities[k] : 0;
        }
        if (!(h[i].x > 0)) continue;
        const std::size_t region = region_of(w[i], h[i].x);
        out.integral[region] += h[i].x * area;
        ++counts[region];
    }
    for (std::size_t k = 0; k < totals.size(); ++k) out.target_shares[k] /= std::max(totals[k], 1.0);
    for (std::size_t r = 0; r < regions; ++r) {
        const double root = std::sqrt(std::max(counts[r], 1.0));
        out.error[r] = out.integral[r] / (root * std::sqrt(root));
    }
}

/// The constant that remains besides a factor, and whether the two explain the weights in all regions.
struct WeightFit {
    double constant = 1, error = 0, p = 0;  // W is constant x factor times what it should be
};
WeightFit fit_of(const ReservoirSums& sums, std::size_t factor) {
    const RegionSums& region_sums = sums.weight_sums[factor];
    double estimate = 0, integral = 0, variance = 0;
    for (std::size_t r = 0; r < regions; ++r) {
        estimate += region_sums[r].sum / sums.draws;
        integral += sums.integral[r];
        variance += region_sums[r].squares / sqr(sums.draws);
    }
    if (!(estimate > 0) || !(integral > 0)) return {};
    WeightFit out{.constant = estimate / integral, .error = std::sqrt(variance) / integral};
    double chi2 = 0, region_count = 0;
    for (std::size_t r = 0; r < regions; ++r) {
        const double d = region_sums[r].sum / sums.draws, expected = out.constant * sums.integral[r];
        if (std::max(d, expected) < least_region * estimate) continue;
        const double v =
            std::max(region_sums[r].squares - sqr(region_sums[r].sum) / sums.draws, 0.0) / sqr(sums.draws) +
            sqr(out.constant * sums.error[r]);
        chi2 += sqr(d - expected) / std::max(v, 1e-300);
        ++region_count;
    }
    out.p = region_count > 1 ? chi_squared_p(chi2, region_count - 1) : 1;
    return out;
}

/// Candidates whose target is 0 do not count in M. With a share s of candidates that count and a share e of empty
/// reservoirs, W is (1 - e) / s times what it should be, for every M.
std::string count_sentence(const ReservoirSums& sums, const WeightFit& fit, const Traits& traits) {
    if (traits.domain) return "";
    constexpr const char* names[] = {"uniform over the sphere", "uniform over the hemisphere", "by the cosine"};
    const double full_share = 1 - sums.empty_draws / sums.draws;
    std::string candidates;
    double least_share = 1;
    for (std::size_t k = 0; k < sums.target_shares.size(); ++k) {
        const double share = sums.target_shares[k], explained_constant = full_share / std::max(share, 1e-9);
        if (std::fabs(explained_constant - 1) < 0.01 ||
            std::fabs(fit.constant - explained_constant) > clear_constant * fit.error + 0.005 * explained_constant)
            continue;
        candidates += fmt::format("{}{}", candidates.empty() ? "" : " or ", names[k]);
        least_share = std::min(least_share, share);
    }
    if (!candidates.empty())
        return fmt::format(
            " Of candidates {} a share of {:.3g} has a target above 0: only these are counted in M, and "
            "all have to be.",
            candidates, least_share);
    return "";
}

std::string text_of(std::size_t factor, const WeightFit& fit, const ReservoirSums& sums, const Traits& traits) {
    if (factor != constant_index)
        return factor < single_surface_factors
            ? fmt::format("With {} in the place of W the draws follow the target: {}.",
                  weight_factors[factor].corrected_weight, weight_factors[factor].fault)
            : fmt::format("With {} the draws follow the target: {}.", weight_factors[factor].corrected_weight,
                  weight_factors[factor].fault);
    const std::string number = number_name(fit.constant, std::max(2 * fit.error, detection_floor), traits);
    std::string out = fmt::format("W is {}{} times what it should be, by the same factor in all directions.",
        with_error(fit.constant, half_width_95 * fit.error), number.empty() || number == "1" ? "" : " = " + number);
    if (fit.constant > 1) return out + count_sentence(sums, fit, traits);
    if (number.empty())
        out +=
            " So it is if M counts candidates or neighbours that add nothing, or if reservoirs are dropped after W was "
            "computed.";
    return out;
}

}  // namespace

std::optional<Cause> reciprocal_weight_cause(std::span<const CheckCase> check_cases, const CheckOutcome& outcome) {
    for (std::size_t k = 0; k < outcome.checks.size(); ++k)
        for (const CheckAt& c : outcome.checks[k]) {
            if (c.findings.empty()) continue;
            const CheckCase& check_case = check_cases[outcome.check_cases[k]];
            Source source(*check_case.adapter, c.technique, check_case.wo, check_case.light);
            ReservoirSums sums;
            add_points(source, sums);
            add_draws(source,
                {.seed = 23,
                    .place = static_cast<std::uint16_t>(outcome.check_cases[k]),
                    .technique = static_cast<std::uint8_t>(c.technique),
                    .stage = 8,
                    .purpose = Purpose::light,
                    .part = 0},
                sums);
            std::optional<Cause> cause;
            for (std::size_t f = 0; f < factor_count(source.traits); ++f) {
                const WeightFit fit = fit_of(sums, f);
                if (fit.p < rejection_level) continue;
                if (fit.p < weights_fit || cause) return {};  // unclear, or two of them
                if (f == constant_index && std::fabs(fit.constant - 1) < clear_constant * fit.error) return {};
                cause = Cause{.factor = weight_factors[f].name,
                    .exponent = fit.constant,
                    .error = fit.error,
                    .text = text_of(f, fit, sums, source.traits),
                    .verdict = "mean"};
                if (f == constant_index) return cause;
            }
            return cause;
        }
    return {};
}

}  // namespace crescent::check
