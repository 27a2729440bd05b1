// Compares p with the derivatives of the sampling map at a few points of u. Near w(u) a sampler with two numbers draws
// with density at least 1 / |dw/du| (other u may map to the same direction), so p |dw/du| >= 1 if p is the density of
// the draws. With three numbers, one of which only selects a branch, p |dw/du| is at least the length of the interval
// of that branch. The test detects parameters that differ between sample and pdf by less than the draws of a quick
// check can show.
#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/decide/small_tests.h"

namespace crescent::check {

namespace {

constexpr std::uint32_t points = 64;
constexpr int coarsest = 6;  // steps from 2^-6 to 2^-21
constexpr std::size_t steps = 16;
constexpr double smooth = 1.1;  // largest ratio of pdf values within a difference
constexpr int bisections = 24;  // for the ends of a branch, to 2^-24

struct Point {
    PrimarySample u;
    double branch = 1;          // probability of the branch that contains u
    int first = 0, second = 1;  // the numbers that move w
    Vec3d w{};
    double area = 0, error = 1;  // |dw/du| and its relative error
};

bool drawn(const Draw& d) { return d.delta == 0 && d.pdf > 0 && std::isfinite(d.wi.x + d.wi.y + d.wi.z); }
bool same_direction(const Draw& a, const Draw& b) {
    return drawn(a) && drawn(b) &&
        std::fabs(a.wi.x - b.wi.x) + std::fabs(a.wi.y - b.wi.y) + std::fabs(a.wi.z - b.wi.z) < 1e-7;
}

std::vector<Draw> draws_at(Source& source, const std::vector<PrimarySample>& u) {
    std::vector<Draw> out(u.size());
    source.draw(u, out);
    return out;
}

/// The length of the interval of number k about u in which the draw does not change, by bisection.
std::vector<double> branch_lengths(
    Source& source, const std::vector<PrimarySample>& u, const std::vector<Draw>& at, int k) {
    std::vector<double> length(u.size());
    for (double end : {0.0, 1.0}) {
        std::vector<double> inside(u.size()), outside(u.size(), end);
        for (std::size_t i = 0; i < u.size(); ++i) inside[i] = u[i][k];
        std::vector<PrimarySample> v = u;
        for (int step = 0; step <= bisections; ++step) {
            for (std::size_t i = 0; i < u.size(); ++i)
                v[i][k] = std::clamp(step == 0 ? end : (inside[i] + outside[i]) / 2, ulp, 1 - ulp);
            const std::vector<Draw> d = draws_at(source, v);
            for (std::size_t i = 0; i < u.size(); ++i) {
                const bool same = same_direction(d[i], at[i]);
                if (step == 0 && same) inside[i] = outside[i] = end;
                else if (step > 0 && inside[i] != outside[i])
                    (same ? inside[i] : outside[i]) = (inside[i] + outside[i]) / 2;
            }
        }
        for (std::size_t i = 0; i < u.size(); ++i) length[i] += std::fabs(inside[i] - u[i][k]);
    }
    return length;
}

/// The one of three numbers that only selects a branch; none if every number moves w.
std::optional<int> chooser(Source& source, const std::vector<PrimarySample>& u, const std::vector<Draw>& at) {
    constexpr double small_move = 0x1p-16;
    for (int k = 2; k >= 0; --k) {
        std::vector<PrimarySample> v = u;
        for (PrimarySample& x : v) x[k] += x[k] < 0.5 ? small_move : -small_move;
        const std::vector<Draw> d = draws_at(source, v);
        int moved = 0, tested = 0;
        for (std::size_t i = 0; i < u.size(); ++i)
            if (drawn(at[i])) ++tested, moved += !same_direction(d[i], at[i]);
        if (tested >= 16 && moved * 20 <= tested) return k;
    }
    return {};
}

/// w(u + h) - w(u - h) along both numbers, and the range of the pdf of these draws.
struct Difference {
    Vec3d along[2]{};
    double area = -1, least_pdf = 0, most_pdf = 0;  // |dw/du|; -1 if a draw is missing
};
using CentralDifferences = std::array<Difference, steps>;

double step_size(std::size_t s) { return std::ldexp(1.0, -coarsest - static_cast<int>(s)); }

std::vector<CentralDifferences> differences(Source& source, const std::vector<Point>& all) {
    std::vector<CentralDifferences> out(all.size());
    for (std::size_t s = 0; s < steps; ++s) {
        const double h = step_size(s);
        std::vector<PrimarySample> u;
        for (const Point& p : all)
            for (int side = 0; side < 4; ++side) {
                u.push_back(p.u);
                double& x = u.back()[side < 2 ? p.first : p.second];
                x = std::clamp(x + (side % 2 ? -h : h), 0.0, 1 - ulp);
            }
        const std::vector<Draw> d = draws_at(source, u);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Draw* q = &d[4 * i];
            const double x = all[i].u[all[i].first], y = all[i].u[all[i].second];
            if (std::min({x, y, 1 - x, 1 - y}) < 2 * h || !std::all_of(q, q + 4, drawn)) continue;
            const Vec3d a = q[0].wi - q[1].wi, b = q[2].wi - q[3].wi, n = cross(a, b);
            const auto [least, most] = std::minmax({q[0].pdf, q[1].pdf, q[2].pdf, q[3].pdf});
            out[i][s] = {{a, b}, std::sqrt(dot(n, n)) / (4 * h * h), least, most};
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
            const Vec3d off = d[k].along[n] - d[s].along[n] * (step_size(k) / step_size(s));
            if (dot(off, off) > sqr(jacobian_error) * dot(d[s].along[n], d[s].along[n])) return false;
        }
    }
    return true;
}

/// Uses the finest central differences of which three successive steps agree and whose pdf values are nearly equal.
void differentiate(Source& source, std::vector<Point>& all) {
    const std::vector<CentralDifferences> of = differences(source, all);
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t s = steps - 2; s-- > 0;) {  // finest first
            const Difference *a = &of[i][s], *b = a + 1, *c = a + 2;
            if (!(a->area > 0 && b->area > 0 && c->area > 0)) continue;
            const double least = std::min({a->least_pdf, b->least_pdf, c->least_pdf});
            const double most = std::max({a->most_pdf, b->most_pdf, c->most_pdf});
            const double error = std::max(std::fabs(a->area - b->area), std::fabs(b->area - c->area)) / b->area;
            if (!(most <= smooth * least) || !(error < jacobian_error) || !is_linear_below(of[i], s + 1)) continue;
            all[i].error = error, all[i].area = (4 * b->area - a->area) / 3;
            break;
        }
}

struct Round {
    int tested = 0, broken = 0;
    double worst = 1;
    Example first{};
};

Round test_points(Source& source, const StreamKey& key) {
    Round out;
    for (const MapDensity& x : map_densities(source, key)) {
        ++out.tested;
        const double ratio = x.p / x.drawn;
        if (ratio >= 1 - jacobian_tolerance - 4 * x.error) continue;
        if (out.broken++ == 0) out.first = {x.u, x.draw, x.p, x.drawn};
        out.worst = std::min(out.worst, ratio);
    }
    return out;
}

}  // namespace

std::vector<MapDensity> map_densities(Source& source, const StreamKey& key) {
    std::vector<MapDensity> out;
    if (source.traits.own_random || !source.adapter.can_draw() || source.traits.numbers < 2 ||
        source.traits.numbers > 3)
        return out;
    const std::vector<PrimarySample> u = first_numbers(key, points, source.traits);
    const std::vector<Draw> at = draws_at(source, u);
    std::vector<double> branch(u.size(), 1.0);
    int first = 0, second = 1;
    if (source.traits.numbers == 3) {
        const std::optional<int> k = chooser(source, u, at);
        if (!k) return out;
        first = *k == 0 ? 1 : 0, second = *k == 2 ? 1 : 2;
        branch = branch_lengths(source, u, at, *k);
    }
    std::vector<Point> all;
    std::vector<Draw> of;
    std::vector<Vec3d> w;
    for (std::size_t i = 0; i < u.size(); ++i)
        if (drawn(at[i]))
            all.push_back({u[i], branch[i], first, second, at[i].wi}), w.push_back(at[i].wi), of.push_back(at[i]);
    differentiate(source, all);
    std::vector<double> p(w.size());
    source.density(w, p);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Point& x = all[i];
        if (!(x.error < jacobian_error) || !(p[i] > 0) || !(x.branch > 1e-3)) continue;
        out.push_back({x.u, of[i], p[i], x.branch / x.area, x.error});
    }
    return out;
}

std::optional<SmallFault> jacobian(Source& source, const StreamKey& given) {
    if (!source.has_density()) return {};
    StreamKey key = given;
    const Round one = test_points(source, key);
    if (one.broken < jacobian_breaks) return {};
    key.part = 1;
    const Round two = test_points(source, key);
    if (two.broken < jacobian_breaks) return {};
    return SmallFault{Family::jacobian, static_cast<double>(one.broken + two.broken),
        static_cast<double>(one.tested + two.tested), std::min(one.worst, two.worst) - 1, one.first,
        "p is less than what is drawn"};
}

}  // namespace crescent::check
