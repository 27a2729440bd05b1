// A phase function comes as f |cos|, which depends on the angle between w_o and w_i alone and is not 0 under the
// surface. No index scales what passes, and it is f |cos| that is reciprocal, not f.
#include "trials/phase.h"

#include <cmath>

#include "simd/frame.h"
#include "simd/random.h"

namespace crescent::inline trials {

namespace {

constexpr std::size_t tried = 64;
constexpr double same_phase = 1e-3;  // relative; nine of ten pairs

/// Pairs all over the sphere, and the same turned about one axis that is none of the surface. Where w_o below is not
/// answered for, both directions of such a pair are negated, which keeps the angle between them.
std::vector<Pair> pairs_and_turned(bool both) {
    const auto at = [](std::uint64_t i, std::uint32_t which) {
        const Vec2<float> u = draw(19, 0, i, which);
        return tilt(180 * static_cast<double>(u.x), 360 * static_cast<double>(u.y));
    };
    const Frame<double> frame = frame_about(tilt(57, 33));
    std::vector<Pair> out;
    for (std::uint64_t i = 0; i < tried; ++i) out.push_back({at(i, 0), at(i, 1)});
    for (std::size_t i = 0; i < tried; ++i) out.push_back({frame.to_world(out[i].wo), frame.to_world(out[i].wi)});
    for (Pair& p : out)
        if (!both && p.wo.z < 0) p = {-p.wo, -p.wi};
    return out;
}

}  // namespace

bool is_phase_function(const Draws& work) {
    if (work.traits.eta || !work.subject.has_f() || !work.whole() || work.scatter().f()) return false;
    const std::vector<Pair> pairs = pairs_and_turned(work.traits.wo == Traits::Asked::both);
    std::vector<double> p(pairs.size());
    work.subject.f(pairs, p);
    for (std::size_t i = 0; i < pairs.size(); ++i) p[i] *= std::fabs(pairs[i].wi.z);
    std::size_t alike = 0;
    for (std::size_t i = 0; i < tried; ++i)
        alike += p[i] > 0 && std::fabs(p[i] - p[tried + i]) <= same_phase * std::max(p[i], p[tried + i]);
    return 10 * alike >= 9 * tried;
}

}  // namespace crescent::inline trials
