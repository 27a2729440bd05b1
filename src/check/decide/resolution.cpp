// The effect of the resolution of random numbers. A threshold within a sampler, such as that between two entries of an
// alias table, lies between two multiples of 2^-24, and a draw on that step belongs to one side only. The chance of a
// draw to be on such a step bounds the share of the draws that the resolution can move.
#include "check/decide/resolution.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/estimate/sampling_map.h"
#include "math/functions.h"

namespace crescent::check {

namespace {

constexpr std::uint32_t moved_draws = 4096;
/// Radians. Derived: in single precision a step of u moves a direction at an axis by up to 7e-4 (`one_direction`).
constexpr double least_jump = 0x1p-10;

Values values_at(Source& source, const Plan& plan, Vec3d w) {
    const double p = source.density(w);
    if (!(p > 0)) return {};
    return plan.values(plan.tree.leaves()[plan.tree.find(to_chart(w))], w, p);
}

/// Whether the two are directions that are not next to each other.
bool jumps(const Draw& a, const Draw& b) { return has_direction(a) && has_direction(b) && chord(a, b) > least_jump; }

}  // namespace

ResolutionEffect resolution_effect(Source& source, const Plan& plan, StreamKey key) {
    ResolutionEffect out;
    if (source.traits.u_bits != 24 || source.traits.own_random || !source.declaration.can_draw) return out;
    key.purpose = Purpose::corners;
    key.part = 24;
    const std::vector<PrimarySample> u = first_numbers(key, moved_draws, source.traits);
    const std::vector<Draw> draws = source.draw(u);
    for (int k = 0; k < source.traits.numbers; ++k) {
        const std::vector<Draw> next_draws = source.draw(moved(u, k, ulp));
        std::vector<std::size_t> rows;     // of the draws that jump
        std::vector<PrimarySample> outer;  // for each of them the number before it, and the one after the next
        for (std::size_t i = 0; i < u.size(); ++i) {
            if (!jumps(draws[i], next_draws[i])) continue;
            rows.push_back(i);
            PrimarySample previous = moved(u[i], k, -ulp);
            previous[k] = std::clamp(previous[k], 0.0, 1 - ulp);
            outer.push_back(previous);
            outer.push_back(moved(u[i], k, 2 * ulp));
        }
        if (rows.empty()) continue;
        const std::vector<Draw> outer_draws = source.draw(outer);
        for (std::size_t j = 0; j < rows.size(); ++j) {
            const Draw &draw = draws[rows[j]], &next_draw = next_draws[rows[j]];
            // A threshold has a branch on either side: before the jump and after it, nothing jumps. A hash of u does.
            if (jumps(outer_draws[2 * j], draw) || jumps(next_draw, outer_draws[2 * j + 1])) continue;
            out.share += 1.0 / moved_draws;
            const Values a = values_at(source, plan, draw.wi), b = values_at(source, plan, next_draw.wi);
            for (std::size_t q = 0; q < integrands; ++q) out.sums[q] += std::fabs(a[q] - b[q]) / moved_draws;
        }
    }
    return out;
}

bool explains(const ResolutionEffect& r, const Answer& a, double draws) {
    const double d = std::fabs(a.difference) - 3 * a.sd;
    switch (a.family) {
        case Family::bridge:
        case Family::bridge_sets: return d <= r.sums[bridge];
        case Family::slope:
        case Family::slope_sets: return d <= r.sums[slope];
        case Family::centre:
        case Family::centre_sets: return d <= r.sums[static_cast<std::size_t>(centre_x + a.member)];
        // As many draws leave a part as the share says, and as many come.
        case Family::node:
        case Family::node_sets:
        case Family::band: return d <= 2 * r.share * a.expected;
        case Family::depth: return d <= 4 * r.share * r.share * draws;
        default: return false;
    }
}

}  // namespace crescent::check
