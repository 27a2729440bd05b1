// Points at which p |Jacobian| is below 1, held against rounding: of the warp's own arithmetic, told by third
// differences; of a table's sums, told by the neighbours. What is left is no matter of the step.
#include "warps/suspects.h"

#include <algorithm>
#include <array>
#include <span>

namespace crescent::inline warps {

namespace {

using namespace differences;

/// The largest |J| of the four quadrants about u, by one-sided differences of second order, and its relative noise.
struct Quadrants {
    double largest = 0, noise = 1;
};

Quadrants quadrants(std::span<const Draw> w, double direction_resolution, double h) {
    Quadrants out;
    for (const Draw& d : w)
        if (!(d.pdf > 0)) return out;
    const Vec3d c = w[0].wi;
    const auto sided = [&](int whole, int half) { return ((w[half].wi - c) * 4.0 - (w[whole].wi - c)) * (1 / h); };
    for (const Vec3d& x : {sided(1, 5), sided(2, 6)})
        for (const Vec3d& y : {sided(3, 7), sided(4, 8)}) {
            const double j = area(x, y);
            if (j <= out.largest) continue;
            out.largest = j;
            out.noise = 8 * direction_resolution / h * (1 / length(x) + 1 / length(y)) * (length(x) * length(y) / j);
        }
    return out;
}

constexpr std::size_t moves = 12;
constexpr double longest = 3001 * 0x1p-24;

/// What twelve draws in a row, each a move of u on, say of the rounding of a warp: the median of their third
/// differences, and the most that one of them goes where most stay where they are.
struct Row {
    double rough = 0, stair = 0;
    bool still = false;  // none of the moves leads on
};
Row row_of(std::span<const Draw, moves> at) {
    std::array<double, moves - 3> rough{}, moved{};
    for (std::size_t k = 0; k < rough.size(); ++k) {
        if (at[k].pdf > 0 && at[k + 1].pdf > 0) moved[k] = length(at[k + 1].wi - at[k].wi);
        if (at[k].pdf > 0 && at[k + 1].pdf > 0 && at[k + 2].pdf > 0 && at[k + 3].pdf > 0)
            rough[k] = length(at[k + 3].wi - at[k].wi + (at[k + 1].wi - at[k + 2].wi) * 3.0);
    }
    std::ranges::nth_element(rough, rough.begin() + rough.size() / 2);
    std::ranges::sort(moved);
    Row out;
    out.rough = rough[rough.size() / 2];
    out.still = !(moved.back() > 0);
    if (!(moved[moved.size() / 2] > 0)) out.stair = moved.back();
    return out;
}

/// How finely the warp is computed at each suspect. A difference of two nearly equal numbers within the sampler may
/// cost most of its digits, of which the direction's own resolution knows nothing. By third differences over moves of
/// u, which leave rounding alone where the warp is smooth, however curved; by their median, since a seam that the moves
/// cross spoils three of nine. Small moves stay within the cell of a table; where floats make stairs of a warp only
/// wide ones leave a stair, of several lengths, since stairs as long as the move look smooth. Where most moves stay on
/// their stair, its height is what the warp is known to; where all of the longest do, moves four times as long are
/// tried.
void find_grains(const TrialContext& work, int technique, std::vector<Suspect>& suspects) {
    std::vector<bool> still(2 * suspects.size(), true);
    for (const double by : {tiny_step, 1267 * 0x1p-24, 2048 * 0x1p-24, longest, 4 * longest}) {
        std::vector<Numbers> u;
        std::vector<std::size_t> lines;
        for (std::size_t line = 0; line < still.size(); ++line) {
            if (by > longest && !still[line]) continue;
            lines.push_back(line);
            const Numbers& from = suspects[line / 2].u;
            const double on = by > longest && from[static_cast<int>(line % 2)] > 0.5 ? -by : by;
            for (std::size_t k = 0; k < moves; ++k)
                u.push_back(from), u.back()[static_cast<int>(line % 2)] += static_cast<double>(k) * on;
        }
        std::vector<Draw> w(u.size());
        work.subject.sample(technique, work.trial.wo, u, w);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            Suspect& s = suspects[lines[i] / 2];
            const Row row = row_of(std::span<const Draw, moves>(&w[i * moves], moves));
            still[lines[i]] = row.still;
            s.resolution = std::max({s.resolution, work.direction_resolution(), 0.5 * row.rough, row.stair});
        }
    }
}

constexpr double fine = 0x1p-13, most = 0.1;  // a step of u; what rounding takes of p |J|

/// p |J| over stencils of `fine` is 1 in the mean, as closely as they scatter.
bool is_one_in_the_mean(const TrialContext& work, int technique, const std::vector<Numbers>& u, const Suspect& s) {
    std::vector<Draw> w(u.size());
    work.subject.sample(technique, work.trial.wo, u, w);
    std::vector<double> all;
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < w.size(); i += stencil) {
        if (!std::all_of(&w[i], &w[i] + stencil, [](const Draw& d) { return d.pdf > 0; })) continue;
        const double j = area(w[i + 1].wi - w[i + 2].wi, w[i + 3].wi - w[i + 4].wi) / sqr(2 * fine);
        all.push_back(std::min(w[i].pdf * j / s.share, 1 + most));
        sum += all.back();
    }
    constexpr std::size_t enough = 6;
    if (all.size() < enough) return false;
    const double n = static_cast<double>(all.size()), mean = sum / n;
    for (double x : all) squares += sqr(x - mean);
    const double se = std::sqrt(squares / (n - 1) / n);
    return std::fabs(mean - 1) < std::min(std::max(0.25 * s.lacking(), 2 * se), 0.5 * s.lacking());
}

/// A table's cumulative sums in single precision round the share of every cell, so that p |J| is a little off in each.
/// A suspect is let go whose neighbours along either number are 1 in the mean (a row may be rounded too); those of a
/// density that is wrong lie below 1 as it does.
void let_go_what_scatters(const TrialContext& work, int technique, std::vector<Suspect>& suspects) {
    constexpr double single = 0x1p-24;
    constexpr std::array apart = {0x1.6p-11, 0x1.4p-10, 0x1.7p-9, 0x1.5p-8};
    if (work.direction_resolution() < single) return;
    for (Suspect& s : suspects) {
        if (!s.stands || s.lacking() > most) continue;
        for (int axis = 0; axis < 2 && s.stands; ++axis) {
            std::vector<Numbers> u;
            for (const double by : apart)
                for (const double side : {-by, by}) {
                    Numbers centre = s.u;
                    centre[axis] += side;
                    for (const Numbers& v : stencil_at(centre, fine)) u.push_back(v);
                }
            s.stands = !is_one_in_the_mean(work, technique, u, s);
        }
    }
}

}  // namespace

/// Looks at every suspect again with steps down to 2^-18.
void look_closer(const TrialContext& work, int technique, std::vector<Suspect>& suspects) {
    find_grains(work, technique, suspects);
    for (std::size_t k = 0; k < look_steps.size(); ++k) {
        std::vector<Numbers> u;
        for (const Suspect& s : suspects)
            for (const Numbers& v : stencil_at(s.u, look_steps[k])) u.push_back(v);
        std::vector<Draw> w(u.size());
        work.subject.sample(technique, work.trial.wo, u, w);
        for (std::size_t i = 0; i < suspects.size(); ++i) {
            Suspect& s = suspects[i];
            const Quadrants q = quadrants(std::span(w).subspan(i * stencil, stencil), s.resolution, look_steps[k]);
            s.here[k] = s.p * q.largest, s.noise[k] = q.noise;
        }
    }
    for (Suspect& s : suspects)
        s.stands = s.stands && !s.settles_at_one() && (s.settles_below() || s.stands_against_rounding());
    let_go_what_scatters(work, technique, suspects);
}

}  // namespace crescent::inline warps
