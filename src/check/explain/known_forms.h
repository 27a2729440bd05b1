// Ratios of draws to p with a parameter that is not stated, from the derivatives of the map, which have no noise.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "check/explain/causes.h"
#include "check/explain/factors.h"
#include "check/explain/hypothesis.h"

namespace crescent::check {

/// Ratios of the draws to p with a fitted parameter: Smith's G1 of the other direction, and the squared distance or the
/// cosine at a light in a plane.
std::optional<Cause> cause_of_known_form(std::span<const KnownRatio> ratios, std::span<const Place> places);
/// What is missing in p, or too often there, if draws follow p over the cosine at a flat light to this power; empty if
/// no factor is known.
std::string plane_words(double power);

}  // namespace crescent::check
