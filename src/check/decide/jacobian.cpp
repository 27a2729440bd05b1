// Compares p with the derivatives of the sampling map at a few points of u. p at a direction is the sum of 1 / |dw/du|
// over all u that lead to it, so that each u gives a lower bound: with two numbers p |dw/du| >= 1. With three numbers,
// one of which only selects a branch, p |dw/du| is at least the measure of the values of that number that select this
// branch. They may be several intervals, such as those of an alias table. The test detects parameters that differ
// between sample and pdf by less than the draws of a quick check can show.
#include "check/decide/jacobian.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/decide/small_tests.h"
#include "check/estimate/sampling_map.h"

namespace crescent::check {

namespace {

constexpr std::uint32_t points = 64;
constexpr int coarsest = 6;  // steps from 2^-6 to 2^-21
constexpr std::size_t steps = 16;
/// Steps that give |dw/du|; finer ones are only compared with them. The finest of the three moves u by 2^8 of its own
/// steps, the middle one, which is used, by 2^9: a map that rounds to such a step, as if a number is used again in
/// single precision, changes it by 0.2 % at most.
constexpr std::size_t steps_used = 12;
constexpr double smooth = 1.1;  // largest ratio of pdf values within a difference
constexpr int probes = 16;      // values of the choosing number at which a branch is looked for
constexpr int bisections = 21;  // for the ends of an interval between two probes, to 2^-24
constexpr double least_branch = 1e-3;
/// Draws at which the intervals of all suspected points of a round are confirmed.
constexpr double most_confirming = 20000;

struct Point {
    PrimarySample u;
    Draw draw;
    int first = 0, second = 1;   // the numbers that move w
    double area = 0, error = 1;  // |dw/du| and its relative error
    Branch branch{};
};

bool same_direction(const Draw& a, const Draw& b) { return has_direction(a) && chord(a, b) < 1e-7; }

/// A value of the choosing number, and whether it selects the branch of the draw at u.
struct Probe {
    double x = 0;
    bool selects = false;
};

/// One end of an interval: between `inner`, which selects the branch, and `outer`.
struct IntervalEnd {
    std::size_t point = 0;
    double inner = 0, outer = 0;
};

/// Whether each of these draws has the direction of its point if number k is replaced by x.
std::vector<bool> selects_branch(Source& source, const std::vector<Point>& points, int k,
    const std::vector<std::pair<std::size_t, double>>& values) {
    std::vector<PrimarySample> u;
    for (const auto& [i, x] : values) {
        u.push_back(points[i].u);
        u.back()[k] = std::clamp(x, ulp, 1 - ulp);
    }
    const std::vector<Draw> d = source.draw(u);
    std::vector<bool> out;
    for (std::size_t j = 0; j < d.size(); ++j) out.push_back(same_direction(d[j], points[values[j].first].draw));
    return out;
}

/// Random values of number k for each point, one in each of `probes` equal parts, with both ends of [0, 1] and u.
std::vector<std::vector<Probe>> probe_branches(
    Source& source, const std::vector<Point>& points, int k, const StreamKey& key) {
    Stream stream(key);
    std::vector<std::pair<std::size_t, double>> values;
    for (std::size_t i = 0; i < points.size(); ++i) {
        values.emplace_back(i, 0.0);
        for (int n = 0; n < probes; ++n) values.emplace_back(i, (n + stream.number()) / probes);
        values.emplace_back(i, 1.0);
    }
    const std::vector<bool> selections = selects_branch(source, points, k, values);
    std::vector<std::vector<Probe>> out(points.size());
    for (std::size_t j = 0; j < values.size(); ++j) out[values[j].first].push_back({values[j].second, selections[j]});
    for (std::size_t i = 0; i < points.size(); ++i) {
        out[i].push_back({points[i].u[k], true});
        std::ranges::sort(out[i], {}, &Probe::x);
    }
    return out;
}

/// Adds one interval for each run of probes that select the branch; its ends are located by bisection. An interval
/// within the gap between two probes is not found, which `is_confirmed` allows for.
void find_branches(Source& source, std::vector<Point>& points, int k, const StreamKey& key) {
    const std::vector<std::vector<Probe>> branch_probes = probe_branches(source, points, k, key);
    std::vector<IntervalEnd> ends;
    struct Run {
        std::size_t point;
        double from, to;                               // probes
        std::optional<std::size_t> low_end, high_end;  // indices into `ends`
    };
    std::vector<Run> runs;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::vector<Probe>& probes = branch_probes[i];
        std::vector<Run> point_runs;
        for (std::size_t j = 0; j < probes.size(); ++j) {
            if (!probes[j].selects) continue;
            Run run{.point = i, .from = probes[j].x, .to = probes[j].x, .low_end = {}, .high_end = {}};
            const std::size_t first = j;
            while (j + 1 < probes.size() && probes[j + 1].selects) ++j;
            run.to = probes[j].x;
            if (first > 0) {
                run.low_end = ends.size();
                ends.push_back({i, run.from, probes[first - 1].x});
            }
            if (j + 1 < probes.size()) {
                run.high_end = ends.size();
                ends.push_back({i, run.to, probes[j + 1].x});
            }
            point_runs.push_back(run);
        }
        runs.insert(runs.end(), point_runs.begin(), point_runs.end());
    }
    for (int step = 0; step < bisections; ++step) {
        std::vector<std::pair<std::size_t, double>> values;
        for (const IntervalEnd& e : ends) values.emplace_back(e.point, (e.inner + e.outer) / 2);
        const std::vector<bool> selections = selects_branch(source, points, k, values);
        for (std::size_t j = 0; j < ends.size(); ++j)
            (selections[j] ? ends[j].inner : ends[j].outer) = values[j].second;
    }
    for (const Run& run : runs)
        points[run.point].branch.intervals.emplace_back(
            run.low_end ? ends[*run.low_end].inner : run.from, run.high_end ? ends[*run.high_end].inner : run.to);
}

/// The one of three numbers that only selects a branch; none if every number moves w.
std::optional<int> chooser(Source& source, const std::vector<PrimarySample>& u, const std::vector<Draw>& draws) {
    constexpr double small_move = 0x1p-16;
    for (int k = 2; k >= 0; --k) {
        const std::vector<Draw> d = source.draw(moved(u, k, small_move));
        int move_count = 0, test_count = 0;
        for (std::size_t i = 0; i < u.size(); ++i)
            if (has_direction(draws[i])) {
                ++test_count;
                move_count += !same_direction(d[i], draws[i]);
            }
        if (test_count >= 16 && move_count * 20 <= test_count) return k;
    }
    return {};
}

/// w(u + h) - w(u - h) along both numbers, and the range of the pdf of these draws.
struct Difference {
    Vec3d changes[2]{};
    double area = -1, least_pdf = 0, most_pdf = 0;  // |dw/du|; -1 if a draw is missing
};
using CentralDifferences = std::array<Difference, steps>;

double step_size(std::size_t s) { return std::ldexp(1.0, -coarsest - static_cast<int>(s)); }

std::vector<CentralDifferences> differences(Source& source, const std::vector<Point>& points) {
    std::vector<CentralDifferences> out(points.size());
    for (std::size_t s = 0; s < steps; ++s) {
        const double h = step_size(s);
        std::vector<PrimarySample> u;
        for (const Point& p : points)
            for (int side = 0; side < 4; ++side) {
                u.push_back(p.u);
                double& x = u.back()[side < 2 ? p.first : p.second];
                x = std::clamp(x + (side % 2 ? -h : h), 0.0, 1 - ulp);
            }
        const std::vector<Draw> d = source.draw(u);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Draw* q = &d[4 * i];
            const double x = points[i].u[points[i].first], y = points[i].u[points[i].second];
            if (std::min({x, y, 1 - x, 1 - y}) < 2 * h || !std::all_of(q, q + 4, has_direction)) continue;
            const Vec3d a = q[0].wi - q[1].wi, b = q[2].wi - q[3].wi, n = cross(a, b);
            const auto [least_pdf, most_pdf] = std::minmax({q[0].pdf, q[1].pdf, q[2].pdf, q[3].pdf});
            out[i][s] = {.changes = {a, b},
                .area = std::sqrt(dot(n, n)) / (4 * h * h),
                .least_pdf = least_pdf,
                .most_pdf = most_pdf};
        }
    }
    return out;
}

/// Whether all differences of finer steps are proportional to that of step s, up to `jacobian_error` of it. Rounding
/// moves each by up to the sampler's own step; three differences of a few such steps each, in the ratio of the steps in
/// u, would agree exactly. Differences across the pieces of a table are not proportional either.
bool is_linear_below(const CentralDifferences& d, std::size_t s) {
    for (std::size_t k = s + 1; k < steps; ++k) {
        if (!(d[k].area >= 0)) return false;
        for (int n = 0; n < 2; ++n) {
            const Vec3d deviation = d[k].changes[n] - d[s].changes[n] * (step_size(k) / step_size(s));
            if (dot(deviation, deviation) > sqr(jacobian_error) * dot(d[s].changes[n], d[s].changes[n])) return false;
        }
    }
    return true;
}

/// Uses the finest central differences of `steps_used` of which three successive steps agree and whose pdf values are
/// nearly equal.
void differentiate(Source& source, std::vector<Point>& points) {
    const std::vector<CentralDifferences> slopes = differences(source, points);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t s = steps_used - 2; s-- > 0;) {  // finest first
            const Difference *a = &slopes[i][s], *b = a + 1, *c = a + 2;
            if (!(a->area > 0 && b->area > 0 && c->area > 0)) continue;
            const double smallest_pdf = std::min({a->least_pdf, b->least_pdf, c->least_pdf});
            const double largest_pdf = std::max({a->most_pdf, b->most_pdf, c->most_pdf});
            const double error = std::max(std::fabs(a->area - b->area), std::fabs(b->area - c->area)) / b->area;
            if (!(largest_pdf <= smooth * smallest_pdf) || !(error < jacobian_error) ||
                !is_linear_below(slopes[i], s + 1))
                continue;
            points[i].error = error;
            points[i].area = (4 * b->area - a->area) / 3;
            break;
        }
}

/// Whether random values of the choosing number within the intervals of a branch all select it. If a share g of the
/// intervals does not, none of 9 / g values shows it with probability 1.2e-4; g is the shortfall of p that it explains.
bool is_confirmed(Source& source, const MapDensity& x, double shortfall, Stream& stream) {
    std::vector<Point> points(1);
    points[0].u = x.u;
    points[0].draw = x.draw;
    const double length = x.branch.length();
    std::vector<std::pair<std::size_t, double>> values(static_cast<std::size_t>(std::ceil(9 / shortfall)));
    for (auto& [point, value] : values) {
        double position = length * stream.number();
        for (const auto& [from, to] : x.branch.intervals) {
            value = from + std::max(position, 0.0);
            if ((position -= to - from) < 0) break;
        }
    }
    return std::ranges::all_of(
        selects_branch(source, points, x.branch.number, values), [](bool selects) { return selects; });
}

struct Round {
    int test_count = 0, fault_count = 0;
    double worst = 1;
    Example first{};
};

/// A point fails if p is below its bound and, where a number chooses a branch, the intervals of that branch are
/// confirmed, the largest shortfalls first.
Round test_points(Source& source, const StreamKey& key) {
    Round out;
    std::vector<std::pair<double, const MapDensity*>> suspects;  // p over its bound
    const std::vector<MapDensity> densities = map_densities(source, key);
    for (const MapDensity& x : densities) {
        ++out.test_count;
        const double ratio = x.p / x.density;
        if (ratio < 1 - jacobian_tolerance - 4 * x.error) suspects.emplace_back(ratio, &x);
    }
    std::ranges::sort(suspects, {}, &std::pair<double, const MapDensity*>::first);
    StreamKey confirming_key = key;
    confirming_key.part = static_cast<std::uint16_t>(key.part + 32);
    Stream stream(confirming_key);
    double cost = 0;
    for (const auto& [ratio, x] : suspects) {
        if (x->branch.number >= 0) {
            if ((cost += 9 / (1 - ratio)) > most_confirming) break;
            if (!is_confirmed(source, *x, 1 - ratio, stream)) continue;
        }
        if (out.fault_count++ == 0) {
            out.first = {.u = x->u, .draw = x->draw, .p = x->p, .expected = x->density};
            out.worst = ratio;
        }
    }
    return out;
}

}  // namespace

std::vector<MapDensity> map_densities(Source& source, const StreamKey& key) {
    std::vector<MapDensity> out;
    if (source.traits.own_random || !source.declaration.can_draw || source.traits.numbers < 2 ||
        source.traits.numbers > 3)
        return out;
    const std::vector<PrimarySample> u = first_numbers(key, points, source.traits);
    const std::vector<Draw> draws = source.draw(u);
    std::optional<int> choosing_number;
    int first = 0, second = 1;
    if (source.traits.numbers == 3) {
        choosing_number = chooser(source, u, draws);
        if (!choosing_number) return out;
        first = *choosing_number == 0 ? 1 : 0;
        second = *choosing_number == 2 ? 1 : 2;
    }
    std::vector<Point> candidates;
    for (std::size_t i = 0; i < u.size(); ++i)
        if (has_direction(draws[i]))
            candidates.push_back({.u = u[i], .draw = draws[i], .first = first, .second = second});
    differentiate(source, candidates);
    std::erase_if(candidates, [](const Point& x) { return !(x.error < jacobian_error); });
    if (choosing_number) {
        StreamKey probe_key = key;
        probe_key.part = static_cast<std::uint16_t>(key.part + 16);
        find_branches(source, candidates, *choosing_number, probe_key);
    }
    std::vector<Vec3d> w;
    for (const Point& x : candidates) w.push_back(x.draw.wi);
    std::vector<double> p(w.size());
    source.density(w, p);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Point& x = candidates[i];
        const double length = choosing_number ? x.branch.length() : 1;
        if (!(p[i] > 0) || !(length > least_branch)) continue;
        out.push_back(
            {.u = x.u, .draw = x.draw, .p = p[i], .density = length / x.area, .error = x.error, .branch = x.branch});
        if (choosing_number) out.back().branch.number = *choosing_number;
    }
    return out;
}

std::optional<SmallFault> jacobian(Source& source, const StreamKey& base_key) {
    if (!source.has_density()) return {};
    StreamKey key = base_key;
    const Round first_round = test_points(source, key);
    if (first_round.fault_count < jacobian_breaks) return {};
    key.part = 1;
    const Round second_round = test_points(source, key);
    if (second_round.fault_count < jacobian_breaks) return {};
    return SmallFault{.family = Family::jacobian,
        .times = static_cast<double>(first_round.fault_count + second_round.fault_count),
        .trials = static_cast<double>(first_round.test_count + second_round.test_count),
        .size = std::min(first_round.worst, second_round.worst) - 1,
        .first = first_round.first,
        .what = "p is less than what is drawn"};
}

}  // namespace crescent::check
