// FLIP, how different two pictures look when one flips between them, per pixel in [0, 1]; the one measure here that is
// of pictures, not of radiance. LDR: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom & Fairchild 2020, "FLIP: A
// Difference Evaluator for Alternating Images", PACMCGIT 3(2). HDR: Andersson, Nilsson, Shirley & Akenine-Moller 2021,
// "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics Short Papers.
#pragma once

#include <span>
#include <vector>

namespace crescent::inline comparison {

/// A picture of linear Rec.709, row after row; which way up is the same for both.
struct FlipImage {
    int width = 0, height = 0;
    std::span<const float> r, g, b;
};

/// Channels in [0, 1] (clamped). `pixels_per_degree` of the viewer, 67 at an ordinary desk.
std::vector<float> ldr_flip(const FlipImage& reference, const FlipImage& test, double pixels_per_degree);
/// Radiance of any range: the largest LDR-FLIP over exposures that the reference's luminances ask for, tone-mapped by
/// ACES.
std::vector<float> hdr_flip(const FlipImage& reference, const FlipImage& test, double pixels_per_degree);

/// The exposures that HDR-FLIP looks at: 2^start .. 2^stop in `count` equal steps.
struct FlipExposures {
    double start = 0, stop = 0;
    int count = 2;
};
/// Where HDR-FLIP begins and ends, in stops, from the reference (Andersson et al. 2021, section 3.2).
FlipExposures flip_exposures(const FlipImage& reference);

}  // namespace crescent::inline comparison
