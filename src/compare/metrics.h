// The quantities that are tested at a pixel: Y, and if some render is in colour also R, G and B. Half of a level is for
// Y, a sixth for each channel. A difference in hue at equal luminance is found only in the channels.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace crescent::inline comparison {

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
