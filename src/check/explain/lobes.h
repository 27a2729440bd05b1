// Lobes that one random number chooses among: each is drawn by itself, and p is compared with their sum.
#pragma once

#include "check/explain/causes.h"
#include "check/explain/hypothesis.h"

namespace crescent::check {

/// An interval of the number that chooses.
struct LobeInterval {
    double from = 0, to = 1;
    double share() const { return to - from; }
};
struct LobeChooser {
    int number = 0;
    std::vector<LobeInterval> lobes;
};

/// The one number that chooses among two to eight lobes; none where no number does, or several do.
std::optional<LobeChooser> chooser_of(Source& source, const StreamKey& key);
/// Lobes are drawn with other probabilities than p has them with.
std::optional<Cause> lobe_cause(std::span<const Place> places);

}  // namespace crescent::check
