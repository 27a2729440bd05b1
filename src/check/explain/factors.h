// Candidate factors by which a density, a weight or f may be off, as functions of the directions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "check/explain/causes.h"
#include "check/explain/hypothesis.h"
#include "check/sources/sampler_adapter.h"

namespace crescent::check {

struct Factor {
    std::string name;
    /// Positive; 0 where it says nothing. m: the half vector, of refraction across a boundary whose index is declared.
    std::function<double(Vec3d wo, Vec3d wi)> value;
    /// The same factor times a known number is what people leave out: 4 (w_o.m) is "w_o.m" with 4.
    double usual_constant = 1;
    /// Any exponent can be what is wrong (a roughness, an exponent), not only a simple one.
    bool any_exponent = false;
};

/// What a sampler's traits and light allow; no index is assumed that is not declared.
std::vector<Factor> factors_for(const Traits& traits, const CaseLighting& light);

/// The microfacet's normal that leads from wo to wi, or its opposite: of a reflection, or of a refraction, eta = index
/// beyond over here (Walter et al. 2007, (13), (16)). Unit; n where the two are opposite.
Vec3d half_vector_of(Vec3d wo, Vec3d wi, double eta);

/// "2", "1/pi", "eta^2"; "" where it is no known number. known_to: relative.
std::string number_name(double value, double known_to, const Traits& traits);

// ---- Ratios that are known without noise, as of a weight over f cos / p at a draw: which constant or factor they are.

/// What was given over what is due for one pair of directions; positive.
struct KnownRatio {
    Vec3d wo{}, wi{};
    double value = 1;
    double error = 0;  // relative
};

struct RatioCause {
    std::string name;  // "constant", "cos theta_i"
    double exponent = 0, constant = 1;
    double explained = 0;  // share of the ratios
};

/// Nine of ten are a constant, or a constant times a simple power of one factor; none where half of them are 1.
std::optional<RatioCause> explain_ratios(std::span<const KnownRatio> ratios, std::span<const Factor> factors);

// ---- The regression of a check's counts on candidate factors: which factor, with which exponent, and which constants.

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

// ---- Draws in another frame than p: mirrored, axes exchanged, turned. The sampler is asked for p at transformed
// directions.

/// The reflections, exchanges and turns that have a name, of largest likelihood first.
std::vector<Hypothesis> frame_hypotheses(std::span<const Place> places);

/// The turn of largest likelihood at each place, found from none, and about the z axis from any angle.
struct Turn {
    Vec3d by{};        // axis times angle, radians
    double error = 0;  // of the angle, one standard error
};
struct FoundTurn {
    Hypothesis hypothesis;
    std::vector<Turn> turns;  // by place
    /// Each angle exceeds its error by far.
    bool is_clear() const {
        constexpr double errors = 5;
        return std::ranges::all_of(
            turns, [](const Turn& t) { return dot(t.by, t.by) > errors * errors * t.error * t.error; });
    }
};
std::optional<FoundTurn> turn_hypothesis(std::span<const Place> places);
/// About z by one angle at all places.
std::optional<FoundTurn> azimuth_hypothesis(std::span<const Place> places);

// ---- Lobes that one random number chooses among: each is drawn by itself, and p is compared with their sum.

/// An interval of the number that chooses.
struct LobeInterval {
    double from = 0, to = 1;
    double share() const { return to - from; }
};
struct LobeChooser {
    int number = 0;
    std::vector<LobeInterval> lobes;
};

/// The one number that chooses among two to eight lobes; none where no number does, or several do.
std::optional<LobeChooser> chooser_of(Source& source, const StreamKey& key);
/// Lobes are drawn with other probabilities than p has them with.
std::optional<Cause> lobe_cause(std::span<const Place> places);

// ---- Where draws fall: a share of them spread evenly, none where p is positive, all on a curve.

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

// ---- What explains weights, f and densities that come with the draws: their ratio to what they ought to be is known
// at every draw, without noise.

std::optional<Cause> weight_cause(std::span<const CheckCase> check_cases, const CheckOutcome& outcome);

/// "Weights are f cos / p over cos theta_i and a constant 0.5 = 1/2."
std::string ratio_sentence(const char* given, const char* due, const RatioCause& cause, const Traits& traits);

}  // namespace crescent::check
