// The left side of E[h(draw)] = integral of h p: independent draws, and replicates of scrambled Sobol points. Tests of
// single draws are counted at the same time, and delta parts collected.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "check/estimate/integrals.h"
#include "check/estimate/source.h"
#include "check/estimate/stream.h"

namespace crescent::check {

// ---- Delta parts of the draws: single directions with a stated probability each.

/// q: the probability stated with its draws. other_weights: number of its draws whose weight differs from that of the
/// first.
struct DeltaPart {
    Vec3d wi{};
    double q = 0;
    Vec3d weight{};
    std::uint64_t draws = 0, other_weights = 0;
};

/// Collects delta parts from draws.
class DeltaParts {
public:
    void add(const Draw& d, Vec3d weight);
    /// The parts by direction and q, among `draws` draws in all. A direction and q with several weights are several
    /// parts if each is drawn as often as q: along the normal three indices refract three channels, chosen with equal
    /// probability, to one direction.
    const std::vector<DeltaPart>& parts(double draws) const;
    /// Whether there are more than `most_delta_parts`, as for a distribution that has a density.
    bool scattered() const { return scattered_; }
    bool empty() const { return parts_.empty(); }

private:
    std::vector<DeltaPart> parts_, parts_by_weight_;  // by direction and q; also by weight
    bool scattered_ = false, many_weights_ = false;
};

/// Power by channel that delta parts return from a uniform light: q times weight, with eta^2 for refracted parts. A
/// part that is transmitted straight, as through a hole, is not scaled by an index. Along the normal, where a boundary
/// also refracts straight, draws at another w_o measure the share of holes.
std::array<double, 3> delta_flux(Source& source, const std::vector<DeltaPart>& parts);

// ---- All draws at one w_o.

/// A draw that shows a fault, for the report.
struct Example {
    PrimarySample u;
    Draw draw;
    double p = 0, expected = 0;  // density there; expected value
};

/// Number of occurrences, and the first of them.
struct Count {
    std::uint64_t times = 0;
    Example first{};
    void add(const Example& e) {
        if (times++ == 0) first = e;
    }
};

/// Tests of each draw, for independent draws; `invalid` for all.
struct DrawChecks {
    std::uint64_t draws = 0, directions = 0, deltas = 0, nothing = 0;
    std::uint64_t unusable = 0;     // pdf or direction is not a number
    std::uint64_t bad_weights = 0;  // of directions
    Count invalid;                  // not finite, negative, not unit
    Count pointwise;                // pdf with the draw against pdf(w)
    Count zero;                     // p is 0 at and around a draw
    Count weight;                   // weight against f cos / pdf
    Count reference_f;              // f against its reference value
    std::uint64_t weights = 0;
    // Draws with an evaluation of pdf(w); those whose pdf differs; the number of these that were compared with
    // neighbours of w.
    std::uint64_t evaluated_draws = 0, differing_draws = 0, compared_draws = 0;
    std::uint64_t draws_below = 0;  // counted in `nothing`: draws below the surface with a pdf, at which p is 0
    std::uint64_t null_below = 0;   // draws below the surface at which p is 0, which the estimator ignores
};

/// Sum and sum of squares of a value per draw.
struct Sums {
    double sum = 0, square = 0;
    void add(double x) {
        sum += x;
        square += x * x;
    }
};

/// Weights of the draws in one leaf.
struct WeightSums {
    double count = 0, sum = 0, square = 0, largest = 0;
    void add(double w) {
        ++count;
        sum += w;
        square += w * w;
        largest = std::max(largest, w);
    }
    void add(const WeightSums& o) {
        count += o.count;
        sum += o.sum;
        square += o.square;
        largest = std::max(largest, o.largest);
    }
};

using Replicates = std::array<double, replicate_sets>;

struct Observations {
    double independent = 0, scrambled = 0;  // draws of each kind; scrambled: over all sets
    std::array<Sums, integrands> sums;
    std::vector<double> leaves;  // sum of h over independent draws, by leaf
    ByBand<double> bands{};      // the same by band
    std::vector<float> counts;   // independent draws by leaf, for maps
    std::array<Replicates, integrands> by_set{};
    std::vector<Replicates> node_by_set;  // sum of h, by row of the coarse node that contains a leaf
    DrawChecks checks;
    struct DirectionKey {
        std::uint64_t key;  // hash of the direction
        double p;
    };
    std::vector<DirectionKey> direction_keys;  // of the independent draws
    double mean_p = 0;                         // sum of p over the independent draws
    Sums log_p;                                // ln p less its median
    double slope_log_p = 0;                    // sum of the h of the slope times (ln p less its median)
    std::vector<double> weights;               // X of the first independent draws in their order
    DeltaParts deltas;                         // of independent draws
    std::array<Sums, 3> mean;                  // bridged weights by channel
    std::array<double, 3> delta_power{};       // power returned by delta parts, by channel
    double weighted_draws = 0;                 // number of draws in `mean` and `weights`
    std::uint64_t weightless = 0;              // directions among them without a weight, because there is no p
    /// Without a density: weights by leaf and channel, and draws by rings of 5 degrees about n.
    std::vector<std::array<WeightSums, 3>> weight_leaves;
    std::array<double, 36> rings{};
    std::uint64_t unresolved = 0;  // draws at which p exceeds what the points of its leaf resolve
    double share_unresolved() const { return static_cast<double>(unresolved) / std::max(independent, 1.0); }
    std::uint64_t excess_draws = 0;           // draws whose p exceeds that of every point of the leaf
    std::vector<DensityPoint> excess_points;  // the first of them
};

/// Eight directions within a few roundings of w: moved by 2 and by 8 ulp. The range of p over them is how well p is
/// known in single precision.
std::array<Vec3d, 8> neighbours(Vec3d w);
/// The directions over which p in the sampler's own arithmetic may vary by rounding: w, and w with its length off by 2
/// and by 8 ulp, as the rounding of its coordinates leaves it. The half vector of w_o and w at grazing angles depends
/// on that length as on nothing else: it is divided by |w_o + w|.
std::vector<Vec3d> of_other_lengths(const Source& source, Vec3d w);

/// Adds the draws from the previous look up to this one. Completes the integrals where their points missed something: a
/// draw with p > 2 top lies in a part of its leaf without points, and its contribution to both variances follows from
/// (1).
void observe(Source& source, const Plan& plan, const Look& target, std::uint32_t f_draws, const StreamKey& key,
    Integrals& integrals, Observations& to);

/// The same for draws that are compared with those of another sampler. They need no density: p is evaluated only below
/// the surface, by `lower_source`, to decide which draws count.
void observe_draws(Source& source, Source& lower_source, const Plan& plan, const Look& target, std::uint32_t f_draws,
    const StreamKey& key, Observations& to);
/// Adds the draws of another technique of the sampler: all that two samplers are compared by, apart from delta parts.
void add_technique(const Observations& technique, Observations& to);

// ---- The weights X = f L cos / p of draws, for the tail and the variance.

/// Draws of a batch that belong to the density: their indices in the batch, their directions, p there, and f |cos| if
/// the sampler has f.
struct DrawnDirections {
    std::span<const std::size_t> rows;
    std::span<const Vec3d> wi;
    std::span<const double> p;
    std::span<const Vec3d> f_cos;
};

/// Appends a weight for each draw of the batch, with the radiance of the light and the MIS weight of the technique; 0
/// for a draw without a sample. For three channels the luminance.
void append_weights(
    Source& source, std::span<const Draw> batch, const DrawnDirections& directions, std::vector<double>& to);

}  // namespace crescent::check
