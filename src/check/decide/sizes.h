// Sizes of the faults that a right verdict may hide: for each kind of fault, the size that is found with probability
// `stated_power`, from the variances of the estimates.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "check/estimate/source.h"
#include "check/verdicts/questions.h"

namespace crescent::check {

/// The least fault of one kind that would have been found.
struct FaultSize {
    /// Empty: such a fault changes nothing (a rotation of a uniform density), or was not tested.
    std::optional<double> size;
    /// Change of the distribution by a fault of size 1, as total variation, for faults that may change little.
    double change = std::numeric_limits<double>::infinity();
};

struct SizeTests;

/// A kind of fault whose size a right verdict states. A new kind is a row of fault_kinds() and the function in it.
struct FaultKind {
    struct Words {
        const char* name;   // in the evidence
        const char* found;  // that it would have been found, with the size times `unit`
        const char* least;  // its size, after "The least"
        double unit = 100;  // per cent
    };
    const char* verdict;
    Words of_directions, of_points;
    double target;  // of a quick check
    FaultSize (*size)(const SizeTests& tests);

    const Words& words(const Traits& traits) const { return traits.domain ? of_points : of_directions; }
};
std::span<const FaultKind> fault_kinds();

struct Sizes {
    std::optional<double> integral;  // relative: half the 95 % interval of the integral of p
    std::vector<FaultSize> faults;   // of each of fault_kinds(); empty: nothing was tested

    /// The size of the kind of this name of directions.
    std::optional<double> of(std::string_view name) const;
};

/// level: of a family at stage 1. `draws`: number of draws that are rotated to measure the effect; 8 evaluations each.
Sizes sizes_of(Source& source, const Evidence& e, double level, std::uint32_t draws, const StreamKey& key);

/// The ratio of a size to its target. If a fault of that size changes the distribution by less than the target of a
/// leak, that change is used. 0 if there is no size.
double ratio_of(const FaultSize& size, const FaultKind& kind);
/// The largest of these ratios, and that of the integral; `verdict`: of its kinds alone, if given.
double worst_ratio(const Sizes& sizes, std::string_view verdict = "");

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
