// The quantities that are tested at a pixel: Y, and if some render is in colour also R, G and B. Half of a level is for
// Y, a sixth for each channel. A difference in hue at equal luminance is found only in the channels.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace crescent::inline comparison {

// ---- FLIP: how different two pictures look when one alternates between them, per pixel in [0, 1]; the only metric of
// pictures, not of radiance. LDR: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom & Fairchild 2020, "FLIP: A
// Difference Evaluator for Alternating Images", PACMCGIT 3(2). HDR: Andersson, Nilsson, Shirley & Akenine-Moller 2021,
// "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics Short Papers.

/// A picture in linear Rec.709, row after row; both pictures have their rows in the same order.
struct FlipImage {
    int width = 0, height = 0;
    std::span<const float> r, g, b;
};

/// Channels in [0, 1] (clamped). `pixels_per_degree` of the viewer, 67 at a usual viewing distance.
std::vector<float> ldr_flip(const FlipImage& reference, const FlipImage& test, double pixels_per_degree);
/// Radiance of any range: the largest LDR-FLIP over the exposures of flip_exposures(), tone-mapped by ACES.
std::vector<float> hdr_flip(const FlipImage& reference, const FlipImage& test, double pixels_per_degree);

/// The exposures of HDR-FLIP: 2^start .. 2^stop in `count` equal steps.
struct FlipExposures {
    double start = 0, stop = 0;
    int count = 2;
};
/// Returns the exposures for a reference, in stops (Andersson et al. 2021, section 3.2).
FlipExposures flip_exposures(const FlipImage& reference);

inline constexpr std::size_t colour_quantities = 4;
inline constexpr const char* quantity_names[colour_quantities] = {"Y", "R", "G", "B"};

/// Returns a quantity's share of a level if `of` quantities are tested.
inline double level_share(std::size_t quantity, std::size_t of) {
    if (of == 1) return 1;
    return quantity == 0 ? 0.5 : 0.5 / static_cast<double>(of - 1);
}

/// The p of "no quantity differs" (Bonferroni with those shares), and its quantity; NaN: none was tested.
struct JointP {
    double p = std::nan("");
    std::size_t quantity = 0;
};
/// `each`: p of each quantity, NaN if it was not tested.
inline JointP joint_p(std::span<const double> each) {
    JointP out;
    for (std::size_t q = 0; q < each.size(); ++q) {
        const double p = std::min(1.0, each[q] / level_share(q, each.size()));
        if (std::isnan(each[q]) || p >= out.p) continue;
        out = {p, q};
    }
    return out;
}

}  // namespace crescent::inline comparison
