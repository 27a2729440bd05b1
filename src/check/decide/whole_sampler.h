// Tests of a sampler that belong to no single w_o: w_o and w_i exactly on axes, planes and the horizon and one rounding
// step next to them; f in both directions; weights of combined techniques.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "check/decide/small_tests.h"
#include "check/estimate/source.h"

namespace crescent::check {

/// Directions on axes and planes, and directions one rounding of single precision next to them.
std::vector<Vec3d> special_directions();
/// Draws at special w_o, pdf and f at special w_i and at the directions of a smooth boundary, for one technique.
std::optional<SmallFault> special_places(const SamplerAdapter& adapter, int technique, std::span<const Vec3d> ordinary);
/// f(a, b) against f(b, a), with eta^2 across the surface.
std::optional<SmallFault> reciprocity(const SamplerAdapter& adapter, const StreamKey& key);
/// Tests that the weights of two combined techniques sum to 1 wherever one of them draws.
std::optional<SmallFault> mis_weights(const SamplerAdapter& adapter, Vec3d wo, const StreamKey& key);

/// The ratio f(b, a) / f(a, b): 1 on one side of the surface; across it eta^2 from above to below for radiance, and the
/// reciprocal for importance (Veach 1997, (5.14)).
double reciprocal_ratio(const Traits& traits, const Pair& p, int channel);

}  // namespace crescent::check
