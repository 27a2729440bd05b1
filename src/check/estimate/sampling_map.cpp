// A step of single precision is found by increasing moves of one number, then by bisection.
#include "check/estimate/sampling_map.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"

namespace crescent::check {

namespace {

constexpr double longest_move = 0x1p-4, side_move = 0x1p-10;
constexpr std::ptrdiff_t draws_to_begin = 64;  // without a step among these draws, no others are tested
// They bisect the last fourfold move: the jump is then known to 1/16 of the distance to it.
constexpr int step_halvings = 6;

class Mover {
    static constexpr double largest_jump = 2;  // larger than any distance of directions

public:
    Mover(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w)
        : source_(source), u_(u), w_(w) {}

    /// The jumps of these draws if number k moves inwards by the given distances.
    std::vector<LocalStep> find_jumps(const std::vector<std::size_t>& rows, int k, const std::vector<double>& moves) {
        std::vector<PrimarySample> v;
        for (std::size_t i : rows) { v.push_back(moved(u_[i], k, moves[i])); }
        const std::vector<Draw> draws = source_.draw(v);
        std::vector<LocalStep> out;
        for (std::size_t j = 0; j < rows.size(); ++j) {
            const Vec3d d = draws[j].wi - w_[rows[j]];
            const bool is_drawn = draws[j].pdf > 0 && draws[j].delta == 0;
            out.push_back({is_drawn ? std::sqrt(dot(d, d)) : largest_jump, draws[j].wi});
        }
        return out;
    }

private:
    Source& source_;
    const std::vector<PrimarySample>& u_;
    const std::vector<Vec3d>& w_;
};

/// The jump at the next change of each draw along number k; 0 if the smallest move already changes it, or none does.
std::vector<LocalStep> jumps_along(Mover& mover, int k, std::size_t count) {
    std::vector<LocalStep> out(count);
    std::vector<double> low(count), high(count, ulp);
    std::vector<std::size_t> open(count), closing;
    for (std::size_t i = 0; i < count; ++i) open[i] = i;
    for (double distance = ulp; distance <= longest_move && !open.empty(); distance *= 4) {
        std::vector<std::size_t> unchanged;
        const std::vector<LocalStep> d = mover.find_jumps(open, k, high);
        for (std::size_t j = 0; j < open.size(); ++j) {
            const std::size_t i = open[j];
            if (d[j].jump == 0) {
                low[i] = distance;
                high[i] = 4 * distance;
                unchanged.push_back(i);
            } else if (distance > ulp) {
                out[i] = d[j];
                closing.push_back(i);
            }
        }
        open = std::move(unchanged);
    }
    std::vector<double> middle(count);
    for (int n = 0; n < step_halvings && !closing.empty(); ++n) {
        for (std::size_t i : closing) middle[i] = (low[i] + high[i]) / 2;
        const std::vector<LocalStep> d = mover.find_jumps(closing, k, middle);
        for (std::size_t j = 0; j < closing.size(); ++j) {
            const std::size_t i = closing[j];
            (d[j].jump == 0 ? low[i] : high[i]) = middle[i];
            if (d[j].jump > 0) out[i] = d[j];
        }
    }
    return out;
}

std::vector<LocalStep> steps_of(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w) {
    std::vector<LocalStep> out(w.size());
    Mover mover(source, u, w);
    for (int k = 0; k < source.numbers(); ++k) {
        const std::vector<LocalStep> steps = jumps_along(mover, k, w.size());
        std::vector<std::size_t> jumping;
        for (std::size_t i = 0; i < w.size(); ++i)
            if (steps[i].jump > 0) jumping.push_back(i);
        std::vector<double> side_movement(w.size());  // largest movement of w by another number, per unit
        for (int j = 0; j < source.numbers() && !jumping.empty(); ++j) {
            if (j == k) continue;
            const std::vector<LocalStep> d = mover.find_jumps(jumping, j, std::vector<double>(w.size(), side_move));
            for (std::size_t n = 0; n < jumping.size(); ++n)
                side_movement[jumping[n]] = std::max(side_movement[jumping[n]], d[n].jump / side_move);
        }
        for (std::size_t i : jumping) {
            const double jump = steps[i].jump, area = jump * std::max(side_movement[i], two_pi / 2 * jump);
            if (jump > out[i].jump && area <= one_direction) out[i] = steps[i];
        }
    }
    return out;
}

}  // namespace

std::vector<LocalStep> local_steps(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w) {
    if (source.traits.own_random || !source.declaration.can_draw) return {};
    const auto first = std::min<std::ptrdiff_t>(draws_to_begin, std::ssize(w));
    const std::vector<LocalStep> first_steps =
        steps_of(source, {u.begin(), u.begin() + first}, {w.begin(), w.begin() + first});
    const bool has_steps = std::ranges::any_of(first_steps, [](const LocalStep& s) { return s.jump > 0; });
    return has_steps ? steps_of(source, u, w) : first_steps;
}

}  // namespace crescent::check
