// Candidate factors by which a density, a weight or f may be off, as functions of the directions.
#pragma once

#include <functional>
#include <string>
#include <vector>

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

}  // namespace crescent::check
