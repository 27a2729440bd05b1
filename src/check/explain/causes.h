// The cause of a wrong verdict: candidate causes, each a rule for any sampler, and the one that the evidence supports.
// Factors come from one regression over the leaves of all w_o; frames, rotations and leaks from likelihoods; lobes from
// the draws of each. A cause is named only if the sampler, corrected for it, passes the failed tests, and no other
// candidate does as well; otherwise no cause is named.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "check/decide/check_sampler.h"
#include "check/explain/constants.h"
#include "check/explain/hypothesis.h"
#include "check/sources/check_case.h"

namespace crescent::check {

struct Cause {
    std::string factor;              // a name of the list: "constant", "cos theta_i"
    double exponent = 0, error = 0;  // draws / pdf ~ factor^exponent; for a constant its value
    std::string text;                // a sentence
    std::string verdict{};           // the explained verdict; "": the first wrong one of density and normalised
};

/// The cause; none if no cause is named.
std::optional<Cause> cause_of(std::span<const CheckCase> check_cases, const CheckOutcome& outcome);

// ---- Candidate factors for an error of a density, a weight or f, as functions of the directions.

struct Factor {
    std::string name;
    /// Positive; 0 if it is not defined. m: the half vector; for refraction across a boundary with a declared index.
    std::function<double(Vec3d wo, Vec3d wi)> value;
    /// The constant that is often omitted together with the factor: for "w_o.m" it is 4, from 4 (w_o.m).
    double usual_constant = 1;
    /// Whether any exponent is possible (a roughness, an exponent), not only a simple one.
    bool any_exponent = false;
};

/// The factors that apply to a sampler's traits and light. An index is used only if it is declared.
std::vector<Factor> factors_for(const Traits& traits, const CaseLighting& light);

/// The microfacet normal between wo and wi, or its opposite: for a reflection, or for a refraction with eta = index on
/// the other side over the index on this side (Walter et al. 2007, (13), (16)). Unit length; n if the two directions
/// are opposite.
Vec3d half_vector_of(Vec3d wo, Vec3d wi, double eta);

/// "2", "1/pi", "eta^2"; "" for an unknown number. precision: relative.
std::string number_name(double value, double precision, const Traits& traits);

// ---- Ratios without noise, such as that of a weight to f cos / p at a draw, and the constant or factor that they
// have.

/// The ratio of a given to the expected value for one pair of directions; positive.
struct KnownRatio {
    Vec3d wo{}, wi{};
    double value = 1;
    double error = 0;  // relative
};

struct RatioCause {
    std::string name;  // "constant", "cos theta_i"
    double exponent = 0, constant = 1;
    double explained_share = 0;  // share of the ratios
};

/// A constant, or a constant times a simple power of one factor, if nine of ten ratios agree with it; none if half of
/// them are 1.
std::optional<RatioCause> explain_ratios(std::span<const KnownRatio> ratios, std::span<const Factor> factors);

// ---- The regression of the counts of a check on candidate factors: the factor, its exponent, and the constants.

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

// ---- Draws in another frame than p: mirrored, axes exchanged, rotated. p is evaluated at transformed directions.

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

// ---- Candidates over domains other than directions (explain/domain_causes.cpp).

/// Functions of the point, such as the radius in a disk.
std::vector<Factor> domain_factors(const std::shared_ptr<const DomainChart>& chart);
/// Coordinates exchanged or mirrored, entries off by one.
std::vector<Hypothesis> domain_frames(std::span<const Place> places);
/// Draws are those of p with the coordinate of an infinite line multiplied by a number.
struct FittedMove {
    Hypothesis hypothesis;
    std::string factor, coordinate;
    double value = 0, error = 0, neutral_value = 0;
    bool is_clear() const { return std::fabs(value - neutral_value) > clear_move * error; }
};
std::vector<FittedMove> domain_moves(std::span<const Place> places);
/// Draws are those of p with other shares of the entries of a set, in a product with other parts.
struct EntryShares {
    struct Share {
        double drawn_share = 0, claimed_share = 0, error = 0;  // of the draws and of p, and of `drawn_share`
    };
    Hypothesis hypothesis;
    std::vector<Share> shares;  // by entry
};
std::optional<EntryShares> entry_shares(std::span<const Place> places);

// ---- Causes that the derivatives of sample(u) show without noise.

/// A power of a random number is missing or once too often in sample: a root (explain/warps.cpp).
std::optional<Cause> warp_cause(std::span<const Place> places);
/// Ratios of the draws to p with a fitted parameter: Smith's G1 of the other direction, and the squared distance or the
/// cosine at a light in a plane (explain/known_forms.cpp).
std::optional<Cause> cause_of_known_form(std::span<const KnownRatio> ratios, std::span<const Place> places);
/// What is missing in p, or too often there, if draws follow p over the cosine at a flat light to this power; empty if
/// no factor is known (explain/known_forms.cpp).
std::string plane_words(double power);

// ---- Lobes selected by one random number: each is drawn separately, and p is compared with their sum.

/// An interval of the number that selects a lobe.
struct LobeInterval {
    double from = 0, to = 1;
    double share() const { return to - from; }
};
struct LobeChooser {
    int number = 0;
    std::vector<LobeInterval> lobes;
};

/// The number that selects among two to eight lobes; none if no number or several numbers do.
std::optional<LobeChooser> chooser_of(Source& source, const StreamKey& key);
/// Lobes are drawn with other probabilities than those in p.
std::optional<Cause> lobe_cause(std::span<const Place> places);

// ---- The location of the draws: a share of them is spread uniformly, none where p is positive, or all on a curve.

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

// ---- Causes for weights, f and densities that are returned with the draws: their ratio to the expected value is known
// at every draw, without noise.

std::optional<Cause> weight_cause(std::span<const CheckCase> check_cases, const CheckOutcome& outcome);
/// A constant or a factor by which random weights W that estimate 1/p are off (explain/reciprocal_weights.cpp).
std::optional<Cause> reciprocal_weight_cause(std::span<const CheckCase> check_cases, const CheckOutcome& outcome);

/// "Weights are f cos / p over cos theta_i and a constant 0.5 = 1/2."
std::string ratio_sentence(const char* subject, const char* expected, const RatioCause& cause, const Traits& traits);

}  // namespace crescent::check
