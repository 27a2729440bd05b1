// The neighbours that `crescent check` supplies to a sampler that merges reservoirs.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"

namespace crescent {

/// A surface point beside the tested one (the receiver), in the receiver's local frame, n = +z.
struct Neighbour {
    Vec3d wo, n;       // unit; w_o is on the side of n on which the receiver's is of +z
    double light = 1;  // the light that reaches it, relative to the receiver's; 0: its target is 0 everywhere
    static constexpr std::size_t columns = 7;
    static constexpr int largest_count = 64;
};

/// The same for the same w_o. One of eight is in the shadow.
std::vector<Neighbour> neighbours_of(Vec3d wo, int count);
/// Appends their number and their columns: wox woy woz nx ny nz light.
void add_neighbours(std::span<const Neighbour> neighbours, std::vector<double>& to);

/// A direction in the local frame of a neighbour.
Vec3d to_local(const Neighbour& neighbour, Vec3d w);

}  // namespace crescent
