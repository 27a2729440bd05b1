// Draws in another frame than p: mirrored, axes exchanged, rotated. p is evaluated at transformed directions.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "base/vec.h"
#include "check/explain/constants.h"
#include "check/explain/hypothesis.h"

namespace crescent::check {

/// Reflections, exchanges and rotations that have a name, the largest likelihood first.
std::vector<Hypothesis> frame_hypotheses(std::span<const Place> places);

/// The rotation of largest likelihood at one place, searched from the identity; about the z axis from any angle.
struct Turn {
    Vec3d rotation{};  // axis times angle, radians
    double error = 0;  // of the angle, one standard error
};
struct FoundTurn {
    Hypothesis hypothesis;
    std::vector<Turn> turns;  // by place
    /// Whether each angle exceeds its error by far.
    bool is_clear() const {
        return std::ranges::all_of(
            turns, [](const Turn& t) { return dot(t.rotation, t.rotation) > sqr(clear_move) * t.error * t.error; });
    }
};
std::optional<FoundTurn> turn_hypothesis(std::span<const Place> places);
/// A rotation about z by the same angle at all places.
std::optional<FoundTurn> azimuth_hypothesis(std::span<const Place> places);
/// A rotation of the frame of the surface about n, which rotates w_o and w_i, by the same angle at all places.
std::optional<FoundTurn> frame_turn_hypothesis(std::span<const Place> places);

}  // namespace crescent::check
