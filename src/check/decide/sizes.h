// Sizes of the faults that a right verdict may hide: for each kind of fault, the size that is found with probability
// `stated_power`, from the variances of the estimates.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "check/estimate/source.h"
#include "check/verdicts/questions.h"

namespace crescent::check {

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

}  // namespace crescent::check
