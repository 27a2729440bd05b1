// What a right verdict could hide: the size of each kind of fault that would have been found with probability
// `stated_power`, from the variances of the estimates in hand.
#pragma once

#include <optional>

#include "check/verdicts/questions.h"

namespace crescent::check {

/// Empty: this kind of fault changes nothing here (a rotation of an even density), or was not looked for.
struct Sizes {
    std::optional<double> constant;   // relative: p is (1 + e) times what is drawn
    std::optional<double> leak;       // share of the draws that is spread evenly, unknown to p
    std::optional<double> cap;        // mass of a cap that is never drawn
    std::optional<double> rotation;   // radians, about an axis across the mean direction
    std::optional<double> parameter;  // relative error of an exponent: draws by p^(1 + e)
    // What a fault of size 1 changes of what is drawn, as total variation: an even density has nothing to rotate.
    double by_leak = 1, by_rotation = 1, by_parameter = 1;
};

/// level: of a family at stage 1. `draws`: so many are moved to see what a rotation changes; 8 evaluations each.
Sizes sizes_of(Source& source, const Evidence& e, double level, std::uint32_t draws, const StreamKey& key);

/// The largest ratio of a size to its target; where a fault of that size changes less of what is drawn than the target
/// of a leak, that change counts.
double worst_ratio(const Sizes& sizes);

}  // namespace crescent::check
