// The right side of E[h(draw)] = integral of h p: stratified points in the leaves, two in each cell of a grid, so that
// each cell has its own variance. Passes of a staged budget are combined in proportion to their numbers of points.
#pragma once

#include <array>
#include <vector>

#include "samplers/domains/sphere_chart.h"
#include "check/estimate/plan.h"

namespace crescent::check {

/// An estimate of an integral: its value, its variance, and the variance of that variance.
struct Estimate {
    double value = 0, variance = 0, doubt = 0;

    /// Adds two points of one cell, each with weight k.
    void add_pair(double a, double b, double k) {
        value += k * (a + b);
        const double v = k * k * (a - b) * (a - b);
        variance += v;
        doubt += 2.0 / 3 * v * v;  // for v = x^2, x normal: var(v) = 2 E[v]^2, of which v^2 2/3 is an unbiased estimate
    }
    void scale(double factor) {
        value *= factor;
        variance *= factor * factor;
        doubt *= factor * factor * factor * factor;
    }
    void add(const Estimate& other) {
        value += other.value;
        variance += other.variance;
        doubt += other.doubt;
    }
};

/// The integrals over one leaf.
struct LeafIntegral {
    Estimate mass, bridge;        // of p and of h p
    double second = 0;            // integral of h^2 p: weight of one draw in the variance
    double solid_angle = 0;       // integral of h where p > 0: for draws spread uniformly
    double top = 0;               // largest p at its points
    double per_point = 0;         // weight of one point
    double tabulation_error = 0;  // largest effect of the error of a tabulated p
    double rounding = 0;          // relative error of p by the sampler's arithmetic, at most 1
};

/// A point with light: the weight X = f L cos / p of a draw there (the luminance for three channels), with the MIS
/// weight of the technique, and its contributions to the integrals of X p and of p.
struct WeightedPoint {
    double x = 0, light = 0, chance = 0;
};

/// Integrals of f |cos| by channel.
struct LightIntegrals {
    std::array<Estimate, 3> integral, mean, albedo;  // plain; bridged with p for `mean`; as flux
    Estimate lost;                                   // times the light, where p is 0
    Estimate lit;                                    // times the light
    std::vector<std::array<Estimate, 3>> leaves;     // f cos by leaf, if no density divides the draws
    std::vector<WeightedPoint> weighted_points;      // where p > 0 and X > 0
    Estimate separate_lost;                          // of the leaves with p = 0 at a point, from separate points
    double largest_lost = 0;                         // largest contribution of one of these points
    std::vector<std::size_t> lost_leaves;            // these leaves, including those given before a pass
    double points = 0;
    void scale(double factor);
    void add(const LightIntegrals& other);
};

struct Integrals {
    std::array<Estimate, integrands> sums;
    Estimate unresolved;  // of p where it exceeds what the points of its leaf resolve
    std::vector<LeafIntegral> leaves;
    ByBand<Estimate> bridge_by_band;  // of h p
    ByBand<double> second_by_band{};  // of h^2 p
    LightIntegrals light;
    std::array<double, integrands> uniform_sums{}, uniform_squares{};  // integrals of h and h^2 where p > 0
    std::array<double, integrands> tabulation_error{};  // largest effect of the error of a tabulated p on `sums`
    double domain = 0;  // solid angle of the upper hemisphere, and of the lower where p > 0
    double points = 0;
    std::vector<DensityPoint> heavy;  // points with a large share of the mass, which the tree does not resolve
};

/// Adds a pass of about `points` points. uses_f: also evaluates f at them.
void integrate(
    Source& source, const Plan& plan, std::uint32_t points, bool uses_f, const StreamKey& key, Integrals& to);

/// h of the mean: f cos bridged with p, so that no weight exceeds the usual one; 1 if that is not possible.
inline double mean_bridge(double f_cos, double p, double mean_weight, bool has_bridge) {
    if (!has_bridge) return 1;
    return p > 0 && mean_weight > 0 ? mean_weight * p / (mean_weight * p + f_cos) : 0;
}
/// Whether the mean is bridged: not without a density, and not if h would depend on random estimates.
inline bool is_bridged(const Source& source) {
    return source.has_density() && !source.estimates && !source.f_estimates;
}
/// The factor from f across the surface, for radiance, to power; 0 if the index is not known.
double flux_factor(const Source& source, Vec3d wi, int channel);

}  // namespace crescent::check
