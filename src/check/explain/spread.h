// The location of the draws: a share of them is spread uniformly, none where p is positive, or all on a curve.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "check/explain/causes.h"
#include "check/explain/hypothesis.h"
#include "samplers/traits.h"

namespace crescent::check {

/// A share of the draws is spread uniformly over the sphere or the upper hemisphere, and p does not include it.
struct Leak {
    Hypothesis hypothesis;
    double share = 0, error = 0;
    bool covers_sphere = true;  // else the upper hemisphere
    bool is_clear() const;
};
std::vector<Leak> leak_hypotheses(std::span<const Place> places);
std::string leak_sentence(const Leak& leak, const Traits& traits);

/// A part of the draws has one direction: a delta part that is not declared.
std::optional<Cause> delta_cause(std::span<const Place> places);
/// A curve, if the numbers that change no draw leave fewer than two.
std::optional<Cause> curve_cause(std::span<const Place> places);
/// p is positive where there are no draws.
std::optional<Cause> unreached_cause(std::span<const Place> places);

}  // namespace crescent::check
