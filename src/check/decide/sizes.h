// Sizes of the faults that a right verdict may hide: for each kind of fault, the size that is found with probability
// `stated_power`, from the variances of the estimates.
#pragma once

#include <optional>

#include "check/verdicts/questions.h"

namespace crescent::check {

/// Empty: this kind of fault changes nothing (a rotation of a uniform density), or was not tested.
struct Sizes {
    std::optional<double> constant;   // relative: p is (1 + e) times the density of the draws
    std::optional<double> leak;       // share of the draws that is uniform and missing in p
    std::optional<double> cap;        // mass of a cap that is never drawn
    std::optional<double> rotation;   // radians, about an axis across the mean direction
    std::optional<double> parameter;  // relative error of an exponent: draws by p^(1 + e)
    // Change of the distribution by a fault of size 1, as total variation: a rotation does not change a uniform
    // density.
    double by_leak = 1, by_rotation = 1, by_parameter = 1;
};

/// level: of a family at stage 1. `draws`: number of draws that are rotated to measure the effect; 8 evaluations each.
Sizes sizes_of(Source& source, const Evidence& e, double level, std::uint32_t draws, const StreamKey& key);

/// The largest ratio of a size to its target. If a fault of that size changes the distribution by less than the target
/// of a leak, that change is used.
double worst_ratio(const Sizes& sizes);

}  // namespace crescent::check
