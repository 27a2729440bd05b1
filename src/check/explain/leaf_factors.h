// The regression of a check's counts on candidate factors: which factor, with which exponent, and which constants.
#pragma once

#include "check/explain/factors.h"
#include "check/explain/hypothesis.h"

namespace crescent::check {

/// A factor that draws follow besides p, with its exponent: draws ~ constant p factor^exponent.
struct FactorHypothesis {
    Hypothesis hypothesis;
    std::string name;
    double exponent = 0, fitted = 0, error = 0;
    double usual_constant = 1;
};

/// Draws follow p times a power of a factor, and a free constant.
Hypothesis times(const Factor& factor, double exponent);
/// Single factors of largest likelihood first, those with a simple exponent.
std::vector<FactorHypothesis> factor_hypotheses(std::span<const Place> places);
/// Draws follow a power of p.
std::optional<FactorHypothesis> power_hypothesis(std::span<const Place> places);

}  // namespace crescent::check
