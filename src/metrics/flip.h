// FLIP: how different two pictures look when one alternates between them, per pixel in [0, 1]; the only metric of
// pictures, not of radiance. LDR: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom & Fairchild 2020, "FLIP: A
// Difference Evaluator for Alternating Images", PACMCGIT 3(2). HDR: Andersson, Nilsson, Shirley & Akenine-Moller 2021,
// "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics Short Papers.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/area_pixels.h"

namespace crescent {

/// A picture in linear Rec.709, row after row; both pictures have their rows in the same order.
struct FlipImage {
    int width = 0, height = 0;
    std::span<const float> r, g, b;
};

/// Of a viewer 0.7 m from a 0.7 m wide display of 3840 pixels.
inline constexpr double flip_pixels_per_degree = 67.0206;

/// Channels in [0, 1] (clamped). `pixels_per_degree` of the viewer. `isa`, here and below: a name of isas(), which all
/// return the same bits; "": the best of this machine.
std::vector<float> ldr_flip(
    const FlipImage& reference, const FlipImage& test, double pixels_per_degree, const std::string& isa = "");
/// Radiance of any range: the largest LDR-FLIP over the exposures of flip_exposures(), tone-mapped by ACES.
std::vector<float> hdr_flip(
    const FlipImage& reference, const FlipImage& test, double pixels_per_degree, const std::string& isa = "");

/// The exposures of HDR-FLIP: 2^start .. 2^stop in `count` equal steps.
struct FlipExposures {
    double start = 0, stop = 0;
    int count = 2;
};
/// Returns the exposures for a reference, in stops (Andersson et al. 2021, section 3.2).
FlipExposures flip_exposures(const FlipImage& reference);

/// Returns the mean of hdr_flip() over each area, for each test picture: out[test][area]. `exposures`: those of the
/// reference. Only the pixels of an area's bounds and those that its filters reach are evaluated.
std::vector<std::vector<double>> mean_hdr_flips(const FlipImage& reference, const FlipExposures& exposures,
    std::span<const FlipImage> tests, std::span<const AreaPixels> areas, double pixels_per_degree,
    const std::string& isa = "");

}  // namespace crescent
