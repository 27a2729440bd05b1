// Delta parts of what is drawn: one direction with one stated probability each, which draws show exactly.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "check/estimate/source.h"

namespace crescent::check {

/// q: the probability that its draws state. otherwise: its draws whose weight is not that of the first.
struct DeltaPart {
    Vec3d wi{};
    double q = 0;
    Vec3d weight{};
    std::uint64_t drawn = 0, otherwise = 0;
};

/// Gathered from draws one at a time.
class DeltaParts {
public:
    void add(const Draw& d, Vec3d weight);
    /// By direction and q, of `of` draws in all. A direction and q that come with several weights are several parts if
    /// each comes as often as q says: along the normal three indices refract three channels, chosen alike, to one
    /// direction.
    const std::vector<DeltaPart>& parts(double of) const;
    /// There are more than `most_delta_parts`: what has a density is no delta part.
    bool scattered() const { return scattered_; }
    bool empty() const { return alike_.empty(); }

private:
    std::vector<DeltaPart> alike_, apart_;  // by direction and q; by weight too
    bool scattered_ = false, many_weights_ = false;
};

/// Power by channel that delta parts return of an even light, q times weight, with eta^2 for what is refracted. What
/// goes straight on, as through a hole, no index scales; along the normal, where a boundary refracts straight on too,
/// draws at another w_o tell how much of it that is.
std::array<double, 3> delta_flux(Source& source, const std::vector<DeltaPart>& parts);

}  // namespace crescent::check
