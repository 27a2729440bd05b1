// The left side of E[h(draw)] = integral of h p: independent draws, and replicates of scrambled Sobol points. Checks
// that look at one draw at a time are counted on the way.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "check/estimate/delta_parts.h"
#include "check/estimate/integrals.h"
#include "check/estimate/stream.h"
#include "check/estimate/source.h"

namespace crescent::check {

/// A draw that shows a fault, for the report.
struct Example {
    PrimarySample u;
    Draw draw;
    double p = 0, due = 0;  // density there; what was expected in place of what came
};

/// How often something happened, and the first time.
struct Count {
    std::uint64_t times = 0;
    Example first{};
    void add(const Example& e) {
        if (times++ == 0) first = e;
    }
};

/// Per-draw checks, of independent draws; `invalid` of all.
struct DrawChecks {
    std::uint64_t looked_at = 0, directions = 0, deltas = 0, nothing = 0;
    Count invalid;      // not finite, negative, not unit
    Count pointwise;    // pdf with the draw against pdf(w)
    Count zero;         // p is 0 at and around a draw
    Count weight;       // weight against f cos / pdf
    Count reference_f;  // f against what it ought to be
    std::uint64_t weights = 0;
    // Draws that pdf(w) followed; those whose pdf is another; how many of these were compared with the neighbours of w.
    std::uint64_t followed = 0, odd = 0, odd_compared = 0;
    std::uint64_t null_below = 0;  // draws below the surface at which p is 0: what the estimator takes for nothing
};

/// Sum and sum of squares of a value per draw.
struct Sums {
    double sum = 0, square = 0;
    void add(double x) { sum += x, square += x * x; }
};

/// Weights that fell into one leaf.
struct WeightSums {
    double count = 0, sum = 0, square = 0, largest = 0;
    void add(double w) { ++count, sum += w, square += w * w, largest = std::max(largest, w); }
    void add(const WeightSums& o) {
        count += o.count, sum += o.sum, square += o.square, largest = std::max(largest, o.largest);
    }
};

using Replicates = std::array<double, replicate_sets>;

struct Observations {
    double independent = 0, scrambled = 0;  // draws of each kind; scrambled: in all sets together
    std::array<Sums, integrands> sums;
    std::vector<double> leaves;  // sum of h over independent draws, by leaf
    ByBand<double> bands{};      // the same by band
    std::vector<float> counts;   // independent draws by leaf, for maps
    std::array<Replicates, integrands> by_set{};
    std::vector<Replicates> node_by_set;  // sum of h, by row of the coarse node that a leaf is in
    DrawChecks checks;
    struct Met {
        std::uint64_t key;  // hash of the direction
        double p;
    };
    std::vector<Met> met;                 // of the independent draws
    double mean_p = 0;                    // sum of p over the independent draws
    Sums log_p;                           // of ln p less its median
    double slope_log_p = 0;               // sum of the slope's h times that
    std::vector<double> weights;          // X of the first independent draws in their order, see weights.h
    DeltaParts deltas;                    // of independent draws
    std::array<Sums, 3> mean;             // bridged weights by channel
    std::array<double, 3> delta_power{};  // that delta parts return, by channel
    double weighed = 0;                   // draws that `mean` and `weights` are of
    std::uint64_t weightless = 0;         // directions among them that came with no weight, there being no p
    /// Where there is no density: weights by leaf and channel, and draws by rings of 5 degrees about n.
    std::vector<std::array<WeightSums, 3>> weight_leaves;
    std::array<double, 36> rings{};
    std::uint64_t unmet = 0;             // draws at which p is more than any point of the leaf has met
    std::vector<DensityPoint> unmet_at;  // the first of them
};

/// Draws from the look before up to this one are added. Integrals are completed by what their points have not
/// met: a draw with p > 2 top shows a part of its leaf without points, whose share of both variances (1) itself gives.
void observe(Source& source, const Plan& plan, const Look& look, std::uint32_t of_f, const StreamKey& key,
    Integrals& integrals, Observations& to);

// ---- The weights X = f L cos / p of draws: what the tail and the variance are of.

/// Draws of a batch that are of the density: where they are in the batch, their directions, p there, and f |cos| where
/// the sampler has f.
struct DrawnDirections {
    std::span<const std::size_t> at;
    std::span<const Vec3d> wi;
    std::span<const double> p;
    std::span<const Vec3d> f_cos;
};

/// Appends a weight for each draw of the batch, with the radiance of the light and the technique's MIS weight; 0 for
/// nothing. Of three channels their luminance.
void append_weights(
    Source& source, std::span<const Draw> batch, const DrawnDirections& directions, std::vector<double>& to);

}  // namespace crescent::check
