// Draws in another frame than p: mirrored, axes exchanged, turned. The sampler is asked for p at transformed
// directions.
#pragma once

#include "check/explain/hypothesis.h"

namespace crescent::check {

/// The reflections, exchanges and turns that have a name, of largest likelihood first.
std::vector<Hypothesis> frame_hypotheses(std::span<const Place> places);

/// The turn of largest likelihood at each place, found from none, and about the z axis from any angle.
struct Turn {
    Vec3d by{};        // axis times angle, radians
    double error = 0;  // of the angle, one standard error
};
struct FoundTurn {
    Hypothesis hypothesis;
    std::vector<Turn> turns;  // by place
    /// Each angle exceeds its error by far.
    bool is_clear() const {
        constexpr double errors = 5;
        return std::ranges::all_of(
            turns, [](const Turn& t) { return dot(t.by, t.by) > errors * errors * t.error * t.error; });
    }
};
std::optional<FoundTurn> turn_hypothesis(std::span<const Place> places);
/// About z by one angle at all places.
std::optional<FoundTurn> azimuth_hypothesis(std::span<const Place> places);

}  // namespace crescent::check
