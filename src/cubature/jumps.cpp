// Where a density over (a, b) jumps: along a few parallels and meridians, closed in on by halving.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "cubature/mesh.h"

namespace crescent::inline cubature {

namespace {

constexpr int parallels = 6, probes = 192, bisections_of_a_gap = 44;

/// Where g may jump between two points of one parallel or meridian.
struct Gap {
    bool along_a;
    double across, t0, t1, g0 = 0, g1 = 0;
    Vec2d at(double t) const { return along_a ? Vec2d{t, across} : Vec2d{across, t}; }
};

/// Neighbouring probes that differ, along a few lines of either kind.
std::vector<Gap> gaps_of(const Batch& g) {
    std::vector<Vec2d> where;
    std::vector<Gap> lines;
    for (int kind = 0; kind < 2; ++kind)
        for (int i = 0; i < parallels; ++i) {
            const double span = kind == 0 ? 2 : 1, across = (kind == 0 ? 1 : 2) * (i + 0.4142) / parallels;
            for (int k = 0; k < probes; ++k) {
                const double t = span * (k + 0.5) / probes;
                lines.push_back({kind == 0, across, t, t + span / probes});
                where.push_back(lines.back().at(t));
            }
        }
    std::vector<double> v(where.size());
    g(where, v);
    std::vector<Gap> out;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
        if (lines[i].along_a != lines[i + 1].along_a || lines[i].across != lines[i + 1].across) continue;
        if (!(std::fabs(v[i] - v[i + 1]) > 1e-6 * std::max(v[i], v[i + 1]))) continue;
        out.push_back(lines[i]);
        out.back().g0 = v[i];
        out.back().g1 = v[i + 1];
    }
    const std::size_t most = 240;  // the largest and, in a table all are large, others evenly chosen
    if (out.size() <= most) return out;
    const auto size = [](const Gap& x) { return std::fabs(x.g1 - x.g0) / std::max(x.g0, x.g1); };
    std::vector<Gap> some;
    for (std::size_t i = 0; i < most / 2; ++i) some.push_back(out[i * out.size() / (most / 2)]);
    std::sort(out.begin(), out.end(), [&](const Gap& x, const Gap& y) {
        return std::tuple(-size(x), x.along_a, x.across, x.t0) < std::tuple(-size(y), y.along_a, y.across, y.t0);
    });
    some.insert(some.end(), out.begin(), out.begin() + most / 2);
    return some;
}

/// Closes in on the larger change; what is left of it at 2^-44 of the gap is a jump.
void close_in(std::vector<Gap>& gaps, const Batch& g) {
    std::vector<Vec2d> where(gaps.size());
    std::vector<double> v(gaps.size());
    for (int k = 0; k < bisections_of_a_gap && !gaps.empty(); ++k) {
        for (std::size_t i = 0; i < gaps.size(); ++i) where[i] = gaps[i].at(0.5 * (gaps[i].t0 + gaps[i].t1));
        g(where, v);
        for (std::size_t i = 0; i < gaps.size(); ++i) {
            Gap& x = gaps[i];
            const double mid = 0.5 * (x.t0 + x.t1);
            if (std::fabs(v[i] - x.g0) > std::fabs(v[i] - x.g1)) x.t1 = mid, x.g1 = v[i];
            else x.t0 = mid, x.g0 = v[i];
        }
    }
    std::erase_if(gaps, [](const Gap& x) { return !(std::fabs(x.g1 - x.g0) > 1e-5 * std::max(x.g0, x.g1)); });
}

}  // namespace

Jumps find_jumps(const Batch& g) {
    std::vector<Gap> gaps = gaps_of(g);
    close_in(gaps, g);
    Jumps out;
    for (const Gap& x : gaps) (x.along_a ? out.a : out.b).push_back(0.5 * (x.t0 + x.t1));
    return out;
}

std::vector<double> heights_of(const Jumps& jumps) {
    constexpr double alike = 1e-9;
    std::vector<double> a = jumps.a, out;
    std::sort(a.begin(), a.end());
    for (std::size_t i = 0, next = 0; i < a.size(); i = next) {
        while (next < a.size() && a[next] - a[i] < alike) ++next;
        if (next - i >= parallels - 2) out.push_back(a[i + (next - i) / 2]);
    }
    return out;
}

}  // namespace crescent::inline cubature
