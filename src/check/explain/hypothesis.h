// A hypothesis of what is wrong: the density that the draws would have if it were true. It is checked by the same
// questions as the sampler's own density, so a cause is named only where the sampler that is corrected for it passes.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "check/decide/check_sampler.h"
#include "check/estimate/source.h"

namespace crescent::check {

// ---- Poisson regression of counts on the logarithms of factors: observed ~ expected exp(a_group + sum of b_k x_k),
// with a constant for each group (a w_o). McCullagh and Nelder 1989, "Generalized Linear Models", chapter 6.

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

/// Masses of draws and p at a place: p over what is drawn, by masses or by the bridge, whichever is known better, with
/// its standard error.
struct MassRatio {
    double drawn = 0, claimed = 0, ratio = 1, error = 0;
};
MassRatio mass_ratio(const CheckAt& c);

/// One technique at one w_o that was found wrong, with fresh draws and p there.
struct Place {
    const CheckCase* check_case = nullptr;
    const CheckAt* at = nullptr;
    std::size_t number = 0;  // of the case in the call
    Traits traits{};
    std::vector<Vec3d> w;
    std::vector<double> p;
    std::vector<double> implied;  // density of the draws by the leaves' counts, 1/sr
    double of = 0;                // draws in all
    /// Whether draws where p is 0 count as draws, or as nothing because the pdf with them is 0 too.
    bool draws_at_zero() const { return at->observations.checks.zero.times > 0; }
    const SamplerAdapter& adapter() const { return *check_case->adapter; }
    int technique() const { return at->technique; }
    Source source() const { return {adapter(), technique(), check_case->wo, check_case->light}; }
    /// Streams of the explanation: each has a seed of its own.
    StreamKey key(std::uint32_t seed, Purpose purpose, std::uint16_t part) const {
        return {seed, static_cast<std::uint16_t>(number), static_cast<std::uint8_t>(technique()), 8, purpose, part};
    }
    /// " at w_o 60 deg"; "" for a sampler without w_o.
    std::string where() const { return traits.wo == Traits::WoDomain::none ? "" : " at " + check_case->text(); }
    /// ln of a density at a draw; where it is 0, of e^-14 times the median of p.
    double log_of(double density) const;
    double mean_log(std::span<const double> density) const;
};

/// Up to `most` of those where a question on the density failed, the plainest first; w_o that differ most.
std::vector<Place> places_of(
    std::span<const CheckCase> check_cases, const CheckOutcome& outcome, std::size_t most, std::uint32_t count);

struct Hypothesis {
    std::string name;    // of the cause
    std::string same{};  // what else would say the same, in brackets
    int place = 0;       // in its list, the plainest first
    /// The supposed density of a sampler's technique, 1/sr.
    std::function<void(const SamplerAdapter&, int technique, std::span<const Pair>, std::span<double>)> density;
    /// By place: what that is multiplied by; empty: 1. free: it is set so that the masses agree.
    std::vector<double> constants{};
    bool free = false;
    double constant(std::size_t k) const { return constants.empty() ? 1 : constants[k]; }
    /// By place: what the density integrates to over what p does; empty: the same.
    std::vector<double> masses{};
    /// Mean log likelihood of a draw over the places (that of a Poisson process, so that masses count), relative to
    /// that of p, and its standard error.
    double gain = 0, error = 0, draws = 0;  // draws: that this is known by
    /// Worth a check of its own, which then decides.
    bool helps() const { return gain > error && gain > 0; }
    /// Of the divergence between draws and p, by the leaves; 1 where nothing is left.
    double explained = 0;
};

/// Sets gain, error and explained.
void score(Hypothesis& h, std::span<const Place> places);
/// Both have the same density at nine of ten draws.
bool are_equivalent(const Hypothesis& a, const Hypothesis& b, std::span<const Place> places);
/// Every question on the density is passed at all places with the supposed density in place of p. Sets free constants.
bool passes(Hypothesis& h, std::span<const Place> places, std::uint32_t seed);

}  // namespace crescent::check
