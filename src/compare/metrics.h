// What is tested of a pixel: Y, and where some render is in colour R, G and B beside it. A level is shared: half of it
// goes to Y, a sixth to each channel. A difference in hue at equal luminance is one of channels alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace crescent::inline comparison {

// ---- FLIP, how different two pictures look when one flips between them, per pixel in [0, 1]; the one measure here
// that is of pictures, not of radiance. LDR: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom & Fairchild 2020,
// "FLIP: A Difference Evaluator for Alternating Images", PACMCGIT 3(2). HDR: Andersson, Nilsson, Shirley &
// Akenine-Moller 2021, "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics Short Papers.

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

inline constexpr std::size_t colour_quantities = 4;
inline constexpr const char* quantity_names[colour_quantities] = {"Y", "R", "G", "B"};

/// A quantity's share of a level, `of` quantities being tested.
inline double level_share(std::size_t quantity, std::size_t of) {
    if (of == 1) return 1;
    return quantity == 0 ? 0.5 : 0.5 / static_cast<double>(of - 1);
}

/// The p of "no quantity differs" (Bonferroni with those shares), and the quantity that it is from; NaN: none was
/// tested.
struct JointP {
    double p = std::nan("");
    std::size_t quantity = 0;
};
/// Of the p of each quantity, NaN where it was not tested.
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
