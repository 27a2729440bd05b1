// Candidate factors for an error of a density, a weight or f, as functions of the directions; and the constant or
// factor of ratios without noise, such as that of a weight to f cos / p at a draw.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/vec.h"
#include "check/sources/case_lighting.h"
#include "samplers/traits.h"

namespace crescent::check {

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

}  // namespace crescent::check
