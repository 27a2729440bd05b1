// Where draws fall: a share of them spread evenly, none where p is positive, all on a curve.
#pragma once

#include "check/explain/causes.h"
#include "check/explain/hypothesis.h"

namespace crescent::check {

/// A share of the draws is spread evenly over the sphere, or over the upper half, and p does not have it.
struct Leak {
    Hypothesis hypothesis;
    double share = 0, error = 0;
    bool whole = true;  // sphere
};
std::vector<Leak> leak_hypotheses(std::span<const Place> places);
std::string leak_sentence(const Leak& leak);

/// Numbers that change no draw leave fewer than two.
std::optional<Cause> curve_cause(std::span<const Place> places);
/// p is positive where nothing is drawn.
std::optional<Cause> unreached_cause(std::span<const Place> places);

}  // namespace crescent::check
