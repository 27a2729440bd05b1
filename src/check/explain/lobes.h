// Lobes selected by one random number: each is drawn separately, and p is compared with their sum.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "check/estimate/source.h"
#include "check/explain/causes.h"
#include "check/explain/hypothesis.h"

namespace crescent::check {

/// An interval of the number that selects a lobe.
struct LobeInterval {
    double from = 0, to = 1;
    double share() const { return to - from; }
};
struct LobeChooser {
    int number = 0;
    std::vector<LobeInterval> lobes;
};

/// The number that selects among two to eight lobes; none if no number or several numbers do.
std::optional<LobeChooser> chooser_of(Source& source, const StreamKey& key);
/// Lobes are drawn with other probabilities than those in p.
std::optional<Cause> lobe_cause(std::span<const Place> places);

}  // namespace crescent::check
