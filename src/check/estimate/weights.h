// The weights X = f L cos / p of draws: what the tail and the variance are of.
#pragma once

#include <span>
#include <vector>

#include "check/estimate/source.h"

namespace crescent::check {

/// Draws of a batch that are of the density: where they are in the batch, their directions, p there, and f |cos| where
/// the sampler has f.
struct DrawnDirections {
    std::span<const std::size_t> at;
    std::span<const Vec3d> wi;
    std::span<const double> p;
    std::span<const Vec3d> f_cos;
};

/// Appends a weight for each draw of the batch, with the radiance of the light and the technique's MIS weight; 0 for
/// nothing. Of three channels their luminance.
void append_weights(
    Source& source, std::span<const Draw> batch, const DrawnDirections& directions, std::vector<double>& to);

}  // namespace crescent::check
