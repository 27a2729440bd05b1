// Delta parts of the draws: single directions with a stated probability each.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "check/estimate/source.h"

namespace crescent::check {

/// q: the probability stated with its draws. otherwise: number of its draws whose weight differs from that of the
/// first.
struct DeltaPart {
    Vec3d wi{};
    double q = 0;
    Vec3d weight{};
    std::uint64_t drawn = 0, otherwise = 0;
};

/// Collects delta parts from draws.
class DeltaParts {
public:
    void add(const Draw& d, Vec3d weight);
    /// The parts by direction and q, among `of` draws in all. A direction and q with several weights are several parts
    /// if each is drawn as often as q: along the normal three indices refract three channels, chosen with equal
    /// probability, to one direction.
    const std::vector<DeltaPart>& parts(double of) const;
    /// Whether there are more than `most_delta_parts`, as for a distribution that has a density.
    bool scattered() const { return scattered_; }
    bool empty() const { return alike_.empty(); }

private:
    std::vector<DeltaPart> alike_, apart_;  // by direction and q; also by weight
    bool scattered_ = false, many_weights_ = false;
};

/// Power by channel that delta parts return from a uniform light: q times weight, with eta^2 for refracted parts. A
/// part that is transmitted straight, as through a hole, is not scaled by an index. Along the normal, where a boundary
/// also refracts straight, draws at another w_o measure the share of holes.
std::array<double, 3> delta_flux(Source& source, const std::vector<DeltaPart>& parts);

}  // namespace crescent::check
