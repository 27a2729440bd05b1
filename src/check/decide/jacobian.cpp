// p against the derivatives of the sampling map, at a few points of u. Near w(u) a sampler of two numbers draws with
// density 1 / |dw/du| at least (other u may lead there too), so p |dw/du| >= 1 wherever p is what is drawn; of a
// sampler of three numbers, one of which only chooses a branch, p |dw/du| is at least the length of that choice. It
// shows parameters that differ between sample and pdf by less than the draws of a quick check can.
#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/decide/small_tests.h"

namespace crescent::check {

namespace {

constexpr std::uint32_t points = 64;
constexpr int halvings = 8;     // steps from 2^-5 to 2^-12
constexpr int bisections = 24;  // of the ends of a branch, to 2^-24

struct Point {
    Numbers u;
    double branch = 1;          // probability of the branch that u lies in
    int first = 0, second = 1;  // the numbers that move w
    Vec3d w{};
    double area = 0, error = 1;  // |dw/du| and its relative error
};

bool drawn(const Draw& d) { return d.delta == 0 && d.pdf > 0 && std::isfinite(d.wi.x + d.wi.y + d.wi.z); }
bool same_direction(const Draw& a, const Draw& b) {
    return drawn(a) && drawn(b) &&
        std::fabs(a.wi.x - b.wi.x) + std::fabs(a.wi.y - b.wi.y) + std::fabs(a.wi.z - b.wi.z) < 1e-7;
}

std::vector<Draw> draws_at(Source& source, const std::vector<Numbers>& u) {
    std::vector<Draw> out(u.size());
    source.draw(u, out);
    return out;
}

/// The ends of the interval of number k about u in which the draw stays the same, by bisection.
std::vector<double> branch_lengths(Source& source, const std::vector<Numbers>& u, const std::vector<Draw>& at, int k) {
    std::vector<double> length(u.size());
    for (double end : {0.0, 1.0}) {
        std::vector<double> inside(u.size()), outside(u.size(), end);
        for (std::size_t i = 0; i < u.size(); ++i) inside[i] = u[i][k];
        std::vector<Numbers> v = u;
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

/// The number that only chooses a branch, of three; none where every number moves w.
std::optional<int> chooser(Source& source, const std::vector<Numbers>& u, const std::vector<Draw>& at) {
    constexpr double little = 0x1p-16;
    for (int k = 2; k >= 0; --k) {
        std::vector<Numbers> v = u;
        for (Numbers& x : v) x[k] += x[k] < 0.5 ? little : -little;
        const std::vector<Draw> d = draws_at(source, v);
        int moved = 0, looked = 0;
        for (std::size_t i = 0; i < u.size(); ++i)
            if (drawn(at[i])) ++looked, moved += !same_direction(d[i], at[i]);
        if (looked >= 16 && moved * 20 <= looked) return k;
    }
    return {};
}

/// Central differences at steps that halve; of two neighbouring steps that agree best, Richardson's limit.
void differentiate(Source& source, std::vector<Point>& all) {
    std::vector<std::array<double, halvings>> areas(all.size());
    for (int s = 0; s < halvings; ++s) {
        const double h = std::ldexp(1.0, -5 - s);
        std::vector<Numbers> u;
        for (const Point& p : all)
            for (int side = 0; side < 4; ++side) {
                u.push_back(p.u);
                u.back()[side < 2 ? p.first : p.second] += side % 2 ? -h : h;
            }
        for (Numbers& v : u)
            for (int k = 0; k < Numbers::most; ++k) v[k] = std::clamp(v[k], 0.0, 1 - ulp);
        const std::vector<Draw> d = draws_at(source, u);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Draw* q = &d[4 * i];
            const double x = all[i].u[all[i].first], y = all[i].u[all[i].second];
            const bool fits =
                std::min({x, y, 1 - x, 1 - y}) > 2 * h && drawn(q[0]) && drawn(q[1]) && drawn(q[2]) && drawn(q[3]);
            const Vec3d n = cross(q[0].wi - q[1].wi, q[2].wi - q[3].wi);
            areas[i][static_cast<std::size_t>(s)] = fits ? std::sqrt(dot(n, n)) / (4 * h * h) : -1;
        }
    }
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t s = 0; s + 1 < halvings; ++s) {
            const double coarse = areas[i][s], fine = areas[i][s + 1];
            if (!(coarse > 0 && fine > 0)) continue;
            const double error = std::fabs(coarse - fine) / fine;
            if (error < all[i].error) all[i].error = error, all[i].area = (4 * fine - coarse) / 3;
        }
}

struct Round {
    int looked = 0, broken = 0;
    double worst = 1;
    Example first{};
};

Round look(Source& source, const StreamKey& key) {
    std::vector<Numbers> u;
    for (std::uint32_t i = 0; i < points; ++i) u.push_back(numbers_at(key, i, source.numbers(), source.single()));
    const std::vector<Draw> at = draws_at(source, u);
    std::vector<double> branch(u.size(), 1.0);
    int first = 0, second = 1;
    if (source.traits.numbers == 3) {
        const std::optional<int> k = chooser(source, u, at);
        if (!k) return {};
        first = *k == 0 ? 1 : 0, second = *k == 2 ? 1 : 2;
        branch = branch_lengths(source, u, at, *k);
    }
    std::vector<Point> all;
    std::vector<Vec3d> w;
    for (std::size_t i = 0; i < u.size(); ++i)
        if (drawn(at[i])) all.push_back({u[i], branch[i], first, second, at[i].wi}), w.push_back(at[i].wi);
    differentiate(source, all);
    std::vector<double> p(w.size());
    source.density(w, p);
    Round out;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Point& x = all[i];
        if (!(x.error < jacobian_error) || !(p[i] > 0) || !(x.branch > 1e-3)) continue;
        ++out.looked;
        const double ratio = p[i] * x.area / x.branch;
        if (ratio >= 1 - jacobian_tolerance - 4 * x.error) continue;
        if (out.broken++ == 0) out.first = {x.u, at[0], p[i], x.branch / x.area};
        out.worst = std::min(out.worst, ratio);
    }
    return out;
}

}  // namespace

std::optional<SmallFault> jacobian(Source& source, const StreamKey& given) {
    const int n = source.traits.numbers;
    if (!source.has_density() || source.traits.own_random || !source.subject.draws_at_will() || n < 2 || n > 3)
        return {};
    StreamKey key = given;
    const Round one = look(source, key);
    if (one.broken < jacobian_breaks) return {};
    key.part = 1;
    const Round two = look(source, key);
    if (two.broken < jacobian_breaks) return {};
    return SmallFault{Family::jacobian, static_cast<double>(one.broken + two.broken),
        static_cast<double>(one.looked + two.looked), std::min(one.worst, two.worst) - 1, one.first,
        "p is less than what is drawn"};
}

}  // namespace crescent::check
