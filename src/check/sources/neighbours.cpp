// Normals up to 60 degrees from the receiver's, w_o up to 15 degrees from its w_o, and light of 1/2 to 2 times its
// light: as across an edge or on a bumpy surface.
#include "check/sources/neighbours.h"

#include <cmath>

#include "check/estimate/stream.h"
#include "math/functions.h"
#include "math/simd/frame.h"

namespace crescent {

namespace {

constexpr double degree = pi / 180, farthest_normal = 60 * degree, farthest_wo = 15 * degree;
constexpr double least_cosine = 0.1;                // of w_o about a neighbour's normal
constexpr int shadow_period = 8, shadow_index = 3;  // the fourth of eight

/// At this angle from an axis, and at an azimuth of a share of a turn.
Vec3d tilted(Vec3d axis, double angle, double turn) {
    const math::SinCos polar = math::sincos(angle), azimuth = math::sincos(2 * pi * turn);
    return frame_about(axis).to_world({polar.sin * azimuth.cos, polar.sin * azimuth.sin, polar.cos});
}

}  // namespace

std::vector<Neighbour> neighbours_of(Vec3d wo, int count) {
    constexpr check::StreamKey key{.seed = 0x6e656967, .purpose = check::Purpose::pilot};
    constexpr int numbers = 5;
    const double side = wo.z < 0 ? -1 : 1;
    std::vector<Neighbour> out;
    for (int k = 0; k < count; ++k) {
        const PrimarySample u =
            check::numbers_at(key, static_cast<std::uint32_t>(k), numbers, check::Resolution::standard);
        Neighbour next;
        next.wo = tilted(wo, farthest_wo * u[0], u[1]);
        double angle = farthest_normal * u[2];
        next.n = tilted({0, 0, 1}, angle, u[3]);
        for (int halvings = 0; side * dot(next.wo, next.n) < least_cosine && halvings < 8; ++halvings) {
            angle /= 2;
            next.n = tilted({0, 0, 1}, angle, u[3]);
        }
        if (side * dot(next.wo, next.n) < least_cosine) next.wo = wo;
        if (side * dot(next.wo, next.n) <= 0) next.n = {0, 0, 1};
        next.light = k % shadow_period == shadow_index ? 0 : math::exp(math::log(2.0) * (2 * u[4] - 1));
        out.push_back(next);
    }
    return out;
}

void add_neighbours(std::span<const Neighbour> neighbours, std::vector<double>& to) {
    to.push_back(static_cast<double>(neighbours.size()));
    for (const Neighbour& neighbour : neighbours)
        to.insert(to.end(),
            {neighbour.wo.x, neighbour.wo.y, neighbour.wo.z, neighbour.n.x, neighbour.n.y, neighbour.n.z,
                neighbour.light});
}

Vec3d to_local(const Neighbour& neighbour, Vec3d w) {
    const Frame<double> frame = frame_about(neighbour.n);
    return {dot(frame.t, w), dot(frame.b, w), dot(frame.n, w)};
}

}  // namespace crescent
