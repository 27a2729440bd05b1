// The next change is found by longer and longer moves of one number, then by bisection.
#include "check/estimate/local_steps.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/estimate/chart.h"

namespace crescent::check {

namespace {

constexpr double longest_move = 0x1p-4, side_move = 0x1p-10;
constexpr std::ptrdiff_t draws_to_begin = 64;  // without a step among them there is none
constexpr int halvings = 6;  // of a move that grew fourfold: the jump is then met within 1/16 of the distance to it

class Moved {
    static constexpr double nowhere = 2;  // further than any direction

public:
    Moved(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w)
        : source_(source), u_(u), w_(w) {}

    /// The jump from w of each of these draws, with number k moved by its own distance, inwards.
    std::vector<LocalStep> by_moving(const std::vector<std::size_t>& which, int k, const std::vector<double>& by) {
        std::vector<PrimarySample> v;
        for (std::size_t i : which) {
            v.push_back(u_[i]);
            v.back()[k] += v.back()[k] < 0.5 ? by[i] : -by[i];
        }
        std::vector<Draw> draws(v.size());
        source_.draw(v, draws);
        std::vector<LocalStep> out;
        for (std::size_t j = 0; j < which.size(); ++j) {
            const Vec3d d = draws[j].wi - w_[which[j]];
            const bool drawn = draws[j].pdf > 0 && draws[j].delta == 0;
            out.push_back({drawn ? std::sqrt(dot(d, d)) : nowhere, draws[j].wi});
        }
        return out;
    }

private:
    Source& source_;
    const std::vector<PrimarySample>& u_;
    const std::vector<Vec3d>& w_;
};

/// The jump at the next change of each draw, along number k; 0 where the least move changes it, or none does.
std::vector<LocalStep> jumps_along(Moved& moved, int k, std::size_t count) {
    std::vector<LocalStep> out(count);
    std::vector<double> same(count), other(count, ulp);
    std::vector<std::size_t> open(count), closing;
    for (std::size_t i = 0; i < count; ++i) open[i] = i;
    for (double by = ulp; by <= longest_move && !open.empty(); by *= 4) {
        std::vector<std::size_t> still;
        const std::vector<LocalStep> d = moved.by_moving(open, k, other);
        for (std::size_t j = 0; j < open.size(); ++j) {
            const std::size_t i = open[j];
            if (d[j].jump == 0) same[i] = by, other[i] = 4 * by, still.push_back(i);
            else if (by > ulp) out[i] = d[j], closing.push_back(i);
        }
        open = std::move(still);
    }
    std::vector<double> middle(count);
    for (int n = 0; n < halvings && !closing.empty(); ++n) {
        for (std::size_t i : closing) middle[i] = (same[i] + other[i]) / 2;
        const std::vector<LocalStep> d = moved.by_moving(closing, k, middle);
        for (std::size_t j = 0; j < closing.size(); ++j) {
            const std::size_t i = closing[j];
            (d[j].jump == 0 ? same[i] : other[i]) = middle[i];
            if (d[j].jump > 0) out[i] = d[j];
        }
    }
    return out;
}

std::vector<LocalStep> steps_of(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w) {
    std::vector<LocalStep> out(w.size());
    Moved moved(source, u, w);
    for (int k = 0; k < source.numbers(); ++k) {
        const std::vector<LocalStep> steps = jumps_along(moved, k, w.size());
        std::vector<std::size_t> jumping;
        for (std::size_t i = 0; i < w.size(); ++i)
            if (steps[i].jump > 0) jumping.push_back(i);
        std::vector<double> beside(w.size());  // the furthest that another number moves w, by one
        for (int j = 0; j < source.numbers() && !jumping.empty(); ++j) {
            if (j == k) continue;
            const std::vector<LocalStep> d = moved.by_moving(jumping, j, std::vector<double>(w.size(), side_move));
            for (std::size_t n = 0; n < jumping.size(); ++n)
                beside[jumping[n]] = std::max(beside[jumping[n]], d[n].jump / side_move);
        }
        for (std::size_t i : jumping) {
            const double jump = steps[i].jump, area = jump * std::max(beside[i], two_pi / 2 * jump);
            if (jump > out[i].jump && area <= one_direction) out[i] = steps[i];
        }
    }
    return out;
}

}  // namespace

std::vector<LocalStep> local_steps(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w) {
    if (source.traits.own_random || !source.adapter.can_draw()) return {};
    const auto first = std::min<std::ptrdiff_t>(draws_to_begin, std::ssize(w));
    const std::vector<LocalStep> some =
        steps_of(source, {u.begin(), u.begin() + first}, {w.begin(), w.begin() + first});
    const bool any = std::ranges::any_of(some, [](const LocalStep& s) { return s.jump > 0; });
    return any ? steps_of(source, u, w) : some;
}

}  // namespace crescent::check
