// One technique of a sampler at one w_o: estimates, tests, two stages, findings, and the sizes of the faults that a
// right verdict may hide.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "check/constants.h"
#include "check/decide/small_tests.h"
#include "check/estimate/budget.h"
#include "check/estimate/source.h"
#include "check/verdict.h"
#include "check/verdicts/questions.h"
#include "math/statistics.h"

namespace crescent::check {

// ---- Sizes of the faults that a right verdict may hide: for each kind of fault, the size that is found with
// probability `stated_power`, from the variances of the estimates.

/// Empty: this kind of fault changes nothing (a rotation of a uniform density), or was not tested.
struct Sizes {
    std::optional<double> integral;   // relative: half the 95 % interval of the integral of p
    std::optional<double> constant;   // relative: p is (1 + e) times the density of the draws
    std::optional<double> leak;       // share of the draws that is uniform and missing in p
    std::optional<double> cap;        // mass of a cap that is never drawn
    std::optional<double> rotation;   // radians, about an axis across the mean direction
    std::optional<double> bias;       // relative: of the mean of the weights, where they are all there is
    std::optional<double> parameter;  // relative error of an exponent: draws by p^(1 + e)
    // Change of the distribution by a fault of size 1, as total variation: a rotation does not change a uniform
    // density.
    double leak_change = 1, rotation_change = 1, parameter_change = 1;
};

/// level: of a family at stage 1. `draws`: number of draws that are rotated to measure the effect; 8 evaluations each.
Sizes sizes_of(Source& source, const Evidence& e, double level, std::uint32_t draws, const StreamKey& key);

/// The largest ratio of a size to its target. If a fault of that size changes the distribution by less than the target
/// of a leak, that change is used.
double worst_ratio(const Sizes& sizes);

/// Sizes of differences between two samplers that are found with the stated power: a part of the draws of one that the
/// other lacks, at nine of ten centres, and a distance between the mean directions.
struct DifferenceSizes {
    std::optional<double> part, distance;
};
DifferenceSizes sizes_between(const Evidence& e, double level, std::span<const Vec3d> centres);

/// The relative error of the integral of p, none if that is 0: half its interval where points resolve p, and elsewhere
/// the share of the draws, or what the points hold if this is more; or by how much these may differ.
std::optional<double> error_of_integral(const Integrals& integrals, const Observations& observations);
/// The same with the share of the draws wherever points do not resolve p: what more points may come to.
std::optional<double> error_in_reach(const Integrals& integrals, const Observations& observations);

/// Half the 95 % interval of an integral: Student's t with the degrees of freedom of its variance. Infinite if these
/// are so few that the variance is not known at all.
double half_interval(const Estimate& integral);

/// The inputs of a check at one w_o besides the sampler.
struct CaseData {
    CaseLighting light{};
    std::uint16_t place = 0;  // index of the case in its call: selects its random streams
    Levels levels{};
    double reserved = 0;  // evaluations of a program with a time limit that other w_o need
};

/// A test that failed at both stages, or at one if it needs no second stage (a NaN is not a matter of chance).
struct Finding {
    Answer first, second;
    double members = 1;  // number of members that share alpha1
};

/// The result at one w_o. Evidence is kept for the explanation.
struct CheckAt {
    Vec3d wo{};
    int technique = 0;
    Traits traits{};
    std::vector<Finding> findings;
    std::vector<SmallFault> small;
    std::vector<Answer> suspected;  // failed at stage 1 and passed at stage 2
    std::vector<Answer> answers;    // by family, at the last look: the least p times the number of members
    Sizes sizes;
    bool inconclusive = false;
    InvalidAnswers invalid;          // of pdf(w) and f(w)
    double moved_by_resolution = 0;  // share of the draws, if their numbers are too coarse for a test of the density
    bool nothing_drawn = false;      // no draw is a direction or a delta part, and p is 0 at every point
    bool draws_elsewhere = false;    // whether a sampler that returns no sample here draws at another w_o
    EvaluationNoise scatter;         // of pdf(w) and f(w), if they are random estimates
    int looks = 0;
    std::uint64_t evaluations = 0;
    double seconds = 0;
    std::shared_ptr<const Plan> plan;
    Integrals integrals;
    Observations observations;
    /// The ratio of a size to its target above which a verdict is inconclusive.
    double most_ratio() const;
    /// Whether points do not determine the integral of p.
    bool is_integral_open() const;
    bool wrong() const { return !findings.empty() || !small.empty(); }
    /// Whether the verdict is built on answers of which too many are not numbers, so that it is not given.
    bool is_withheld(std::string_view verdict) const;
};

CheckAt check_sampler_at(const SamplerAdapter& adapter, int technique, Vec3d wo, const CaseData& data,
    const CheckBudget& budget, std::uint32_t seed);

// ---- The tail of the weights X = f L cos / p: the Pareto index k of the largest (PSIS, Vehtari et al. 2024,
// math/statistics.h), and the unseen tail, which is the part of the integral where X is larger than any drawn weight.
// The points of the integrals show the unseen tail; the draws cannot.

/// Of all techniques together.
struct WeightTail {
    bool has_weights = false;      // whether every draw has a weight
    bool has_lower_draws = false;  // whether some draws are below the surface
    Spread spread;
    double variance_error = 0;      // relative standard error of the variance
    std::optional<Tail> fit;        // none if the largest weights are equal
    std::size_t times_largest = 0;  // number of draws of the largest weight
    bool bounded = false;           // whether the largest weight is at most a few means
    double integral = 0;            // integral of f L cos where p > 0, from the points, including delta parts
    // Regions where weights exceed the largest drawn, summed over the techniques:
    double unseen = 0, unseen_error = 0;  // integral of f L cos, and its standard error
    double unseen_chance = 0;             // integral of p
    double half_chance = 0;               // the same over the largest weights that contribute half of `unseen`

    bool heavy() const { return !bounded && fit && fit->k - 2 * fit->se >= heavy_index; }
    /// Whether the interval of k contains 1/2.
    bool open() const { return !bounded && !heavy() && fit && fit->k + 2 * fit->se >= heavy_index; }
    bool has_unseen() const;
};

/// X of each draw, summed over the techniques of one w_o.
std::vector<double> weights_of(std::span<const CheckAt> techniques);
/// Only the fit, for weights without points.
WeightTail tail_of_weights(std::span<const double> x);
WeightTail tail_of(std::span<const CheckAt> techniques);

/// Sets the verdict `tail`: right, or inconclusive with the next step, or skipped.
void test_tail(const CheckCase& check_case, const WeightTail& t, Verdict& v);
/// Adds the plain mean of the weights to the evidence of `mean`. If the weights have no finite variance the verdict
/// becomes inconclusive: the tests passed, but no interval of the plain mean is valid.
void test_plain_mean(const WeightTail& t, Verdict& v);

}  // namespace crescent::check
