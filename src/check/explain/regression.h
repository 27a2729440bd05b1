// The regression of the counts of a check on candidate factors: the factor, its exponent, and the constants. It is a
// Poisson regression on the logarithms of factors: observed ~ expected exp(a_group + sum of b_k x_k), with a constant
// for each group (a w_o). McCullagh and Nelder 1989, "Generalized Linear Models", chapter 6.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "check/explain/factors.h"
#include "check/explain/hypothesis.h"

namespace crescent::check {

/// One cell: observed and expected draws, the variance of the expectation, and the logarithms of the factors.
struct Row {
    std::size_t group = 0;
    double observed = 0, expected = 0, variance = 0;
    double unit = 1;  // variance of one count over its mean
    std::vector<double> x;
};

/// Exponents of the selected factors with standard errors, and the remaining misfit.
struct Fit {
    std::vector<std::size_t> factors;
    std::vector<double> exponents, errors;
    std::vector<double> constants;  // exp(a) by group
    double likelihood = 0;
    double misfit = 0;  // mean squared standardised residual; 1 if the fit explains everything
};

/// Fits the exponents by Newton's method; the constants follow from them.
Fit fit(std::span<const Row> rows, std::size_t groups, std::vector<std::size_t> factors);
/// Forward selection: adds the factor with the largest gain in likelihood if that gain exceeds what chance gives to one
/// of many (BIC and `least_lead`).
Fit select(std::span<const Row> rows, std::size_t groups, std::size_t factors, std::size_t largest_count);

/// A factor of the density of the draws besides p, with its exponent: draws ~ constant p factor^exponent.
struct FactorHypothesis {
    Hypothesis hypothesis;
    std::string name;
    double exponent = 0, fitted_exponent = 0, error = 0;
    double usual_constant = 1;
};

/// Draws follow p times a power of a factor, with a free constant.
Hypothesis times(const Factor& factor, double exponent);
/// Single factors with a simple exponent, the largest likelihood first.
std::vector<FactorHypothesis> factor_hypotheses(std::span<const Place> places);
/// Draws follow a power of p.
std::optional<FactorHypothesis> power_hypothesis(std::span<const Place> places);

}  // namespace crescent::check
