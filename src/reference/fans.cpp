// Gauss-Kronrod over the fans' azimuth, 7 points, each span between two cuts by itself; along each fan lobe_along.h.
// Spans whose rules differ are halved, first at kinks, which bisection finds. Lambert's tolerance is 4e-5 of the whole.
#include "reference/fans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "reference/kronrod.h"
#include "reference/lobe_along.h"

namespace crescent::inline reference {

namespace {

/// What fans add up to: both parts, and the error of the lobe's rule along them.
struct FanSum {
    double diffuse = 0, lobe = 0, inner = 0;
    friend FanSum operator+(FanSum a, FanSum b) { return {a.diffuse + b.diffuse, a.lobe + b.lobe, a.inner + b.inner}; }
    friend FanSum operator-(FanSum a, FanSum b) { return {a.diffuse - b.diffuse, a.lobe - b.lobe, a.inner - b.inner}; }
    friend FanSum operator*(double k, FanSum a) { return {k * a.diffuse, k * a.lobe, k * a.inner}; }
};

/// The fans of a point under one of its lobes.
struct FansUnderLobe {
    AllFans& fans;
    const DiskPoint& point;
    LobeShape shape{point};

    /// What one fan adds.
    FanSum operator()(const OpenFan& fan) const {
        FanSum sum = {fan.diffuse};
        if (!(point.surface.rho_s > 0)) return fan.slope * sum;
        const double width = fans.about_lobe() ? shape.width_at(fan.cos_azimuth) : shape.width,
                     reach = fans.about_lobe() ? shape.reach : pi;
        for (const Interval& open : fans.parts(fan)) {
            const Interval part = {open.lo, std::min(open.hi, reach)};
            if (part.empty()) continue;
            const AlongLobe along = lobe_along(point, fan.axis, fan.aside, part, width);
            sum.lobe += along.value, sum.inner += along.error;
        }
        return fan.slope * sum;
    }
};

/// The fans between two cuts, by u in [0, 1]: tau(u) has no slope at a cut where a shadow opens like a root, which
/// makes that smooth.
struct Span {
    FanCut from, to;

    double tau(double u) const { return from.tau + (to.tau - from.tau) * way(u); }
    /// d tau / d u.
    double slope(double u) const { return (to.tau - from.tau) * rise(u); }

private:
    double way(double u) const {
        if (from.root) return to.root ? u * u * (3 - 2 * u) : u * u;
        return to.root ? u * (2 - u) : u;
    }
    double rise(double u) const {
        if (from.root) return to.root ? 6 * u * (1 - u) : 2 * u;
        return to.root ? 2 * (1 - u) : 1;
    }
};

/// Two rules over a part of a span: the integral, and how far the smaller rule is from it.
struct Panel {
    Span span;
    double lo, hi;  // in u
    FanSum fine, off, spread;
    std::optional<Interval> kink;  // in u: the edges at its ends are others

    Panel(const FansUnderLobe& all, const Span& whole, double u0, double u1) : span(whole), lo(u0), hi(u1) {
        std::array<std::pair<double, FanEdges>, 9> nodes;
        std::size_t count = 0;
        const auto f = [&](double u) {
            const OpenFan& fan = all.fans(span.tau(u));
            nodes[count++] = {u, fan.edges};
            return span.slope(u) * all(fan);
        };
        const TwoRules<FanSum> both = by_two_rules(kronrod_7, f, lo, hi);
        fine = both.fine, off = both.off, spread = both.spread;
        for (const double u : {1e-3, 1 - 1e-3})  // what lies between an end of the span and the node next to it
            if (u > lo && u < hi) nodes[count++] = {u, all.fans.edges_at(span.tau(u))};
        std::sort(nodes.begin(), nodes.begin() + count);
        for (std::size_t k = 0; k + 1 < count && !kink; ++k)
            if (nodes[k].second != nodes[k + 1].second) kink = Interval{nodes[k].first, nodes[k + 1].first};
    }

    /// How far the larger rule may be off: by as much less than the smaller one as that is off by less than the middle.
    FanSum expected_off() const {
        const auto of = [](double error, double coarser) {
            return std::fabs(error) * std::min(1.0, 4 * std::fabs(error) / std::max(std::fabs(coarser), 1e-300));
        };
        return {of(off.diffuse, spread.diffuse), of(off.lobe, spread.lobe), 0};
    }

    /// Where to cut it: at the first kink, else in the middle.
    double cut(AllFans& fans) const {
        if (!kink) return 0.5 * (lo + hi);
        Interval at = *kink;
        const FanEdges before = fans.edges_at(span.tau(at.lo));
        for (int k = 0; k < 9; ++k) {  // what is left over counts by its square
            const double middle = 0.5 * (at.lo + at.hi);
            (fans.edges_at(span.tau(middle)) == before ? at.lo : at.hi) = middle;
        }
        return at.hi;
    }
};

constexpr int halvings = 14, first_halvings = 2;

/// The sum of panels, cut where their rules differ, and first of all at kinks, where a shadow's edge meets the light's:
/// they may lie where no node is.
struct Adaptive {
    const FansUnderLobe& all;
    double tolerance = 0;  // of one panel, in the unit of `weigh`
    DiskIntegral sum{};

    void add(const Panel& panel, int depth = 0) {
        const FanSum off = panel.expected_off();
        const bool good = all.point.weigh({off.diffuse, off.lobe}) <= tolerance;
        if (depth == halvings || (good && !(panel.kink && depth < first_halvings))) {
            sum.diffuse += panel.fine.diffuse, sum.lobe += panel.fine.lobe;
            sum.diffuse_error += std::fabs(panel.off.diffuse),
                sum.lobe_error += std::fabs(panel.off.lobe) + panel.fine.inner;
            return;
        }
        const double cut = panel.cut(all.fans);
        add(Panel(all, panel.span, panel.lo, cut), depth + 1);
        add(Panel(all, panel.span, cut, panel.hi), depth + 1);
    }
};

}  // namespace

DiskIntegral fan_by_fan(const DiskPoint& point, AllFans& fans) {
    const Vec3d d = middle_of(fans.light()) - point.x;
    const double open = disk_area(fans.light()) / dot(d, d);  // Lambert's, about
    if (!(point.weigh({1, 1}) > 0)) return {};                // a black surface
    fans.rewind();
    const FansUnderLobe under_lobe{fans, point};
    const std::vector<FanCut>& cuts = fans.cuts();
    std::vector<Panel> panels;
    double all = 0.01 * point.weigh({std::min(open, 1.0), 0});
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        fans.look_between(cuts[k].tau, cuts[k + 1].tau);
        panels.emplace_back(under_lobe, Span{cuts[k], cuts[k + 1]}, 0, 1);
        all += point.weigh({panels.back().fine.diffuse, panels.back().fine.lobe});
    }
    constexpr double tolerance = 4e-5;
    Adaptive sum{under_lobe, tolerance * all};
    for (const Panel& panel : panels) {
        fans.look_between(panel.span.from.tau, panel.span.to.tau);
        sum.add(panel);
    }
    // Light that falls through a slit between two bodies may fall between two fans.
    const double unseen = fans.bodies() > 1 ? 3e-5 : 0;
    sum.sum.diffuse_error += unseen * std::min(open, 1.0), sum.sum.lobe_error += unseen * sum.sum.lobe;
    return sum.sum;
}

}  // namespace crescent::inline reference
