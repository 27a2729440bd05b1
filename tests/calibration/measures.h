// What the calibration's own tests measure of a sampler, apart from every engine.
#pragma once

#include "tests/calibration/sampler.h"

namespace crescent::calibration {

/// Draws against the density in equal-area cells of the sphere: each cell's integral by stratified points, more of them
/// where the draws are.
struct Fit {
    double integral = 0, drawn = 0;  // of p; share of draws that are something
    double sigmas = 0;               // their difference in standard errors
    double chi2 = 0, degrees = 0;
};
Fit fit_of(const Sampler& sampler, Vec3d wo, int draws, std::uint64_t seed);

/// Share of the draws whose pdf is off pdf(w) by more than 1e-4 (double: 1e-9) of it.
double share_of_other_pdf(const Sampler& sampler, Vec3d wo, int draws, std::uint64_t seed);

/// Directions drawn at numbers from a stream, zero vectors where nothing is drawn; and their densities.
struct Draws {
    std::vector<Vec3d> wi;
    std::vector<double> pdf;
};
Draws draws_of(const Sampler& sampler, Vec3d wo, int count, std::uint64_t seed);
double pdf_at(const Sampler& sampler, Vec3d wo, Vec3d wi);

}  // namespace crescent::calibration
