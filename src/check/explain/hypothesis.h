// A hypothesis about a fault: the density that the draws have if it is true. It is tested in the same way as the
// sampler's own density, so a cause is named only if the corrected sampler passes.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "check/decide/check_sampler.h"
#include "check/decide/jacobian.h"
#include "check/estimate/source.h"

namespace crescent::check {

/// For a sampler whose density alone is tested.
inline void without_f(SamplerDeclaration& declaration) {
    declaration.has_f = false;
    declaration.has_true_f = false;
}

/// Masses of draws and p at a place: p over the density of the draws, from the masses or from the bridge, whichever is
/// more precise, with its standard error.
struct MassRatio {
    double drawn_mass = 0, claimed_mass = 0, ratio = 1, error = 0;
};
MassRatio mass_ratio(const CheckAt& c);

/// One technique at one w_o that is wrong, with fresh draws and p there.
struct Place {
    const CheckCase* check_case = nullptr;
    const CheckAt* check = nullptr;
    std::size_t number = 0;  // index of the case in the call
    Traits traits{};
    std::vector<Vec3d> w;
    std::vector<double> p;
    std::vector<double> implied;  // density of the draws from the counts of the leaves, 1/sr
    double draw_count = 0;        // number of draws
    std::vector<MapDensity> map;  // the density of the sampling map at a few points
    /// Whether draws where p is 0 count as draws; otherwise they count as no sample because their pdf is 0 too.
    bool draws_at_zero() const { return check->observations.checks.zero.times > 0; }
    const SamplerAdapter& adapter() const { return *check_case->adapter; }
    int technique() const { return check->technique; }
    Source source() const { return {adapter(), technique(), check_case->wo, check_case->light}; }
    /// Streams of the explanation; each has its own seed.
    StreamKey key(std::uint32_t seed, Purpose purpose, std::uint16_t part) const {
        return {.seed = seed,
            .place = static_cast<std::uint16_t>(number),
            .technique = static_cast<std::uint8_t>(technique()),
            .stage = 8,
            .purpose = purpose,
            .part = part};
    }
    /// " at w_o 60 deg"; "" for a sampler without w_o.
    std::string where() const { return traits.wo == Traits::WoDomain::none ? "" : " at " + check_case->text(); }
    /// ln of a density at a draw; if the density is 0, ln of e^-14 times the median of p.
    double log_of(double density) const;
    double mean_log(std::span<const double> density) const;
};

/// Up to `largest_count` places where a test of the density failed, at different w_o.
std::vector<Place> places_of(std::span<const CheckCase> check_cases, const CheckOutcome& outcome,
    std::size_t largest_count, std::uint32_t count);

struct Hypothesis {
    std::string name;           // of the cause
    std::string equivalents{};  // names of equivalent causes, in brackets
    int place = 0;              // index in its list, in order of preference
    /// Whether two parameters that belong to x and y, if they are exchanged, have the same effect.
    bool exchanges_parameters = false;
    /// The supposed density of a sampler's technique, 1/sr.
    std::function<void(const SamplerAdapter&, int technique, std::span<const Pair>, std::span<double>)> density;
    /// Factor of the density by place; empty: 1. Chosen with has_free_constant so that the masses agree.
    std::vector<double> constants{};
    bool has_free_constant = false;
    double constant(std::size_t k) const { return constants.empty() ? 1 : constants[k]; }
    /// By place: the integral of the density over that of p; empty: 1.
    std::vector<double> masses{};
    /// Mean log likelihood of a draw over the places (that of a Poisson process, which includes the masses) relative to
    /// that of p, and its standard error.
    double gain = 0, error = 0, draws = 0;  // draws: the number of draws of the estimate
    /// Whether the hypothesis is worth a check.
    bool helps() const { return gain > error && gain > 0; }
    /// Explained share of the divergence between draws and p, from the leaves; 1 if nothing remains.
    double explained_share = 0;
};

/// Sets gain, error and explained_share.
void score(Hypothesis& h, std::span<const Place> places);
/// The density of the draws is at least that of the map at one u. Whether the supposed density is less at more than one
/// of ten points, by half of its difference from p or more: a fitted number that is clear is known to a quarter.
bool is_below_map(const Hypothesis& h, std::span<const Place> places);
/// Whether both have the same density at nine of ten draws.
bool are_equivalent(const Hypothesis& a, const Hypothesis& b, std::span<const Place> places);
/// Whether all tests of the density pass at all places with the supposed density in place of p. Sets free constants.
bool passes(Hypothesis& h, std::span<const Place> places, std::uint32_t seed);
/// Whether all tests of the density pass at all places for a corrected sampler.
bool follows_density(const SamplerAdapter& corrected, std::span<const Place> places, std::uint32_t seed);

}  // namespace crescent::check
