// The right side of E[h(draw)] = integral of h p: stratified points in the leaves, two in each cell of a grid, so that
// every cell has a variance of its own. Passes of a staged budget are merged by their numbers of points.
#pragma once

#include <array>
#include <vector>

#include "check/estimate/chart.h"
#include "check/estimate/plan.h"

namespace crescent::check {

/// An estimate of an integral: its value, its variance, and the variance of that variance.
struct Estimate {
    double value = 0, variance = 0, doubt = 0;

    /// Two points of one cell, each of weight k.
    void add_pair(double a, double b, double k) {
        value += k * (a + b);
        const double v = k * k * (a - b) * (a - b);
        variance += v;
        doubt += 2.0 / 3 * v * v;  // of v = x^2, x normal: var(v) = 2 E[v]^2, of which v^2 2/3 is an unbiased estimate
    }
    void scale(double by) { value *= by, variance *= by * by, doubt *= by * by * by * by; }
    void add(const Estimate& other) { value += other.value, variance += other.variance, doubt += other.doubt; }
};

/// Of one leaf.
struct LeafIntegral {
    Estimate bridge;         // of h p
    double second = 0;       // integral of h^2 p: what one draw counts for
    double solid_angle = 0;  // integral of h where p > 0: what draws spread evenly would give
    double top = 0;          // the largest p that its points have met
    double per_point = 0;    // weight of one point
    double known_to = 0;     // what the error of a tabulated p makes of it at most
};

/// A point where light is: the weight X = f L cos / p of a draw there (of three channels the luminance), with the MIS
/// weight of the technique, and what the point holds of the integrals of X p and of p.
struct WeighedPoint {
    double x = 0, light = 0, chance = 0;
};

/// Integrals of f |cos| by channel.
struct LightIntegrals {
    std::array<Estimate, 3> all, mean, albedo;    // as it is; bridged with p for `mean`; as flux
    Estimate lost;                                // times the light, where p is 0
    Estimate lit;                                 // times the light
    std::vector<std::array<Estimate, 3>> leaves;  // f cos by leaf, where there is no density to divide the draws by
    std::vector<WeighedPoint> weighed;            // where p > 0 and X > 0
    Estimate lost_again;                          // of the leaves where p was 0, by points of their own
    double largest_lost = 0;                      // what one of these points holds, at most
    std::vector<std::size_t> lost_in;             // these leaves; those given before a pass are among them
    double points = 0;
    void scale(double by);
    void add(const LightIntegrals& other);
};

struct Integrals {
    std::array<Estimate, integrands> sums;
    std::vector<LeafIntegral> leaves;
    ByBand<Estimate> bridge_by_band;  // of h p
    ByBand<double> second_by_band{};  // of h^2 p
    LightIntegrals light;
    std::array<double, integrands> even{}, even_square{};  // integrals of h and h^2 where p > 0
    std::array<double, integrands> known_to{};             // what the error of a tabulated p makes of `sums` at most
    double domain = 0;  // solid angle of the upper half, and of the lower where p > 0
    double points = 0;
    std::vector<DensityPoint> heavy;  // points that hold much of the mass each: the tree has missed something there
};

/// Adds a pass of about `points` points. of_f: evaluate f at them too.
void integrate(Source& source, const Plan& plan, std::uint32_t points, bool of_f, const StreamKey& key, Integrals& to);

/// h of the mean: f cos bridged with p, so that no weight counts for more than the usual one; 1 where that cannot be.
inline double mean_bridge(double f_cos, double p, double usual, bool bridged) {
    if (!bridged) return 1;
    return p > 0 && usual > 0 ? usual * p / (usual * p + f_cos) : 0;
}
/// Whether the mean is bridged: not without a density, nor where h would depend on random answers.
inline bool is_bridged(const Source& source) {
    return source.has_density() && !source.estimates && !source.f_estimates;
}
/// What turns f across the surface from radiance into power; 0 where the index is not known.
double flux_factor(const Source& source, Vec3d wi, int channel);

}  // namespace crescent::check
