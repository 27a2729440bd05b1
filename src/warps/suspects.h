// Differences of sample(wo, u) about points u, and the points at which p |Jacobian| is below 1 by them. Steps are of u.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "simd/math.h"
#include "trials/trial_context.h"

namespace crescent::inline warps {

/// Of sample(wo, u) by u.
namespace differences {

inline constexpr double step = 0x1p-8;
inline constexpr double tiny_step = 0x1p-19;
inline constexpr int stencil = 11;  // centre, +-h, +-h/2 along each side, and a tiny move along each

/// The other numbers are held: what chooses among lobes stays with its choice.
inline std::array<Numbers, stencil> stencil_at(const Numbers& centre, double h = step) {
    const double k = h / 2;
    constexpr Vec2d none{0, 0};
    const Vec2d moves[stencil] = {
        none, {h, 0}, {-h, 0}, {0, h}, {0, -h}, {k, 0}, {-k, 0}, {0, k}, {0, -k}, {tiny_step, 0}, {0, tiny_step}};
    std::array<Numbers, stencil> out;
    for (std::size_t i = 0; i < stencil; ++i) {
        out[i] = centre;
        out[i].x += moves[i].x, out[i].y += moves[i].y;
    }
    return out;
}

inline double area(Vec3d a, Vec3d b) { return length(cross(a, b)); }

}  // namespace differences

inline constexpr std::array look_steps = {0x1p-7, 0x1p-8, 0x1p-10, 0x1p-12, 0x1p-14, 0x1p-16, 0x1p-18};

/// A point at which p |J| is below 1.
struct Suspect {
    Numbers u;
    double p, p_j;  // over the share of the choosing number
    double share = 1, allowed = 0;
    bool stands = true;
    double resolution = 0;                         // rounding of the warp there
    std::array<double, look_steps.size()> here{};  // p |J| by each step, and its noise
    std::array<double, look_steps.size()> noise{};

    double lacking() const { return 1 - p_j; }
    bool nearly(double a, double b) const { return std::fabs(a - b) < 0.1 * lacking(); }
    /// The finest steps say the same and less than one, whatever the rounding is thought to be: a warp in doubles.
    bool settles_below() const {
        const std::size_t last = here.size() - 1;
        return nearly(here[last], here[last - 1]) && nearly(here[last - 1], here[last - 2]) && here[last] > 0.1 &&
            here[last] < 1 - 0.3 * lacking();  // on a stair nothing moves
    }
    bool settles_at_one() const {
        for (std::size_t k = 2; k < here.size(); ++k)
            if (nearly(here[k], 1) && nearly(here[k - 1], 1)) return true;
        return false;
    }
    /// One that reaches 1 in any quadrant is let go, and so is one of which no two steps in turn say the same: there
    /// the difference is the step's, not the density's.
    bool stands_against_rounding() const {
        double before = 0;
        bool settled = false;
        for (std::size_t k = 0; k < here.size(); ++k) {
            const double h = look_steps[k];
            if (h < differences::step && 2 * noise[k] > 0.25 * lacking())
                continue;  // lost in rounding: the wider steps decide
            if (h <= differences::step && (here[k] > 1 - 0.3 * lacking() || noise[k] > lacking())) return false;
            settled = settled || (before > 0 && std::fabs(here[k] - before) < 0.5 * lacking());
            before = here[k];
        }
        return settled;
    }
};

/// Looks at every suspect again, with steps down to 2^-18 and at its neighbours; one that rounding explains stands no
/// more.
void look_closer(const TrialContext& work, int technique, std::vector<Suspect>& suspects);

}  // namespace crescent::inline warps
