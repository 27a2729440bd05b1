// Poisson regression of counts on the logarithms of factors: observed ~ expected exp(a_group + sum of b_k x_k), with a
// constant for each group (a w_o). McCullagh and Nelder 1989, "Generalized Linear Models", chapter 6.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace crescent::check {

/// One cell: what was observed and expected in draws, the variance of the expectation, and the logarithms of the
/// factors there.
struct Row {
    std::size_t group = 0;
    double observed = 0, expected = 0, variance = 0;
    double unit = 1;  // variance of one count over its mean: what a draw counts for
    std::vector<double> x;
};

/// Exponents of the chosen factors with standard errors, and what they leave.
struct Fit {
    std::vector<std::size_t> factors;
    std::vector<double> exponents, errors;
    std::vector<double> constants;  // exp(a) by group
    double likelihood = 0;
    double misfit = 0;  // mean of squared standardised residuals, 1 where the fit explains everything
};

/// Newton's method for the exponents; the constants follow from them.
Fit fit(std::span<const Row> rows, std::size_t groups, std::vector<std::size_t> factors);
/// Mean squared standardised residual of the expectation as it is.
double misfit_of(std::span<const Row> rows);
/// Forward selection: the factor of the largest gain in likelihood is kept if that gain exceeds what chance gives to
/// one of many (BIC and `least_gain`).
Fit select(std::span<const Row> rows, std::size_t groups, std::size_t factors, std::size_t most);

}  // namespace crescent::check
