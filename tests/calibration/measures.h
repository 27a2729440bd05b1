// Measurements of a sampler for the tests of the calibration, independent of every engine.
#pragma once

#include "tests/calibration/sampler.h"

namespace crescent::calibration {

/// Draws compared with the density in cells of the sphere: the integral over each cell by stratified points, more of
/// them where the draws are.
struct Fit {
    double integral = 0, drawn = 0;  // of p; share of draws with a sample
    double sigmas = 0;               // their difference in standard errors
    double chi2 = 0, degrees = 0;
};
Fit fit_of(const Sampler& sampler, Vec3d wo, int draws, std::uint64_t seed);

/// Share of the draws whose pdf differs from pdf(w) by a relative error of more than 1e-4 (double: 1e-9).
double share_of_other_pdf(const Sampler& sampler, Vec3d wo, int draws, std::uint64_t seed);

/// Directions drawn with numbers from a stream, zero vectors for no sample; and their densities.
struct Draws {
    std::vector<Vec3d> wi;
    std::vector<double> pdf;
};
Draws draws_of(const Sampler& sampler, Vec3d wo, int count, std::uint64_t seed);
double pdf_at(const Sampler& sampler, Vec3d wo, Vec3d wi);

}  // namespace crescent::calibration
