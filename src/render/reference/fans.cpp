// Gauss-Kronrod over the fans' azimuth, 7 points, one rule for each span between two cuts; along each fan lobe_along().
// Spans whose rules differ are halved, first at kinks, which are found by bisection. Lambert's tolerance is 4e-5 of the
// whole.
#include "render/reference/fans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "math/functions.h"
#include "math/quadrature.h"
#include "render/reference/lobe_albedo.h"

namespace crescent {

// ---- A half-plane from the axis through the point cuts the light's figure in a segment; along it the angle al from
// the axis rises, and Lambert's part has a closed form in al, with a series where it would cancel.

namespace {

/// Returns al - sin(al) cos(al), by its series where the difference would cancel.
double sector(const Direction& d) {
    if (d.al > 0.3) return d.al - d.sin * d.cos;
    const double x = d.al * d.al;
    return d.al * x *
        (2.0 / 3 - x * (2.0 / 15 - x * (4.0 / 315 - x * (2.0 / 2835 - x * (4.0 / 155925 - x * (4.0 / 6081075))))));
}

}  // namespace

Fan::Fan(const DiskPoint& point, const Figure& light, const Frame<double>& frame, const math::SinCos& azimuth)
    : axis(frame.n), side(azimuth.cos * frame.t + azimuth.sin * frame.b) {
    const Vec3d k = cross(axis, side);
    const std::optional<Line> line = std::visit(
        [&](const auto& figure) {
            if constexpr (requires { figure.center; }) return cut(figure, figure.center - point.x, k);
            else return cut(figure, figure.corner - point.x, k);
        },
        light);
    if (!line) return;
    Vec3d from = line->from, to = line->to;
    const double side0 = dot(side, from), side1 = dot(side, to);
    if (side0 <= 0 && side1 <= 0) return;
    const Vec3d end = from + (side0 / (side0 - side1)) * (to - from);  // where the half-plane ends
    if (side0 < 0) from = end;
    if (side1 < 0) to = end;
    if (dot(cross(from, to), k) < 0) std::swap(from, to);  // al rises
    to0 = from;
    step = to - from;
    empty = false;
}

Direction Fan::at(double v) const {
    const Vec3d d = to0 + v * step;
    const double sin = std::max(0.0, dot(d, side)), cos = dot(d, axis), size = 1 / std::sqrt(sin * sin + cos * cos);
    return {sin * size, cos * size, math::atan2(sin, cos)};
}

void Fan::rise_above(const DiskPoint& point, Direction& from, Direction& to) const {  // cos(al - top) > 0
    const double axis_part = dot(point.frame.n, axis), side_part = dot(point.frame.n, side),
                 size = std::sqrt(axis_part * axis_part + side_part * side_part);
    double top = math::atan2(side_part, axis_part);
    if (top < -pi / 2) top += 2 * pi;
    if (from.al < top - pi / 2) from = {-axis_part / size, side_part / size, top - pi / 2};
    if (to.al > top + pi / 2) to = {axis_part / size, -side_part / size, top + pi / 2};
}

double Fan::lambert(const DiskPoint& point, const Direction& from, const Direction& to) const {
    const double axis_part = 0.5 * (to.sin + from.sin) * (to.sin - from.sin),
                 side_part = 0.5 * (sector(to) - sector(from));
    return dot(point.frame.n, axis) * axis_part + dot(point.frame.n, side) * side_part;
}

namespace {

/// The sum over fans: both parts, and the error of the lobe's rule along them.
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

    /// Returns the contribution of one fan.
    FanSum operator()(const OpenFan& fan) const {
        FanSum sum = {fan.diffuse};
        if (!(point.surface.rho_s > 0)) return fan.slope * sum;
        const double width = fans.about_lobe() ? shape.width_at(fan.cos_azimuth) : shape.width,
                     reach = fans.about_lobe() ? shape.reach : pi;
        for (const Interval& open : fans.parts(fan)) {
            const Interval part = {open.lo, std::min(open.hi, reach)};
            if (part.empty()) continue;
            const AlongLobe integral = lobe_along(point, fan.axis, fan.side, part, width);
            sum.lobe += integral.value;
            sum.inner += integral.error;
        }
        return fan.slope * sum;
    }
};

/// The fans between two cuts, by u in [0, 1]: tau(u) has slope 0 at a cut where a shadow opens like a root, so the
/// integrand is smooth there.
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

/// Two rules over a part of a span: the integral, and the difference of the smaller rule from it.
struct Panel {
    Span span;
    double lo, hi;  // in u
    FanSum fine, difference, spread;
    std::optional<Interval> kink;  // in u: the edges differ between its two ends

    Panel(const FansUnderLobe& fans, const Span& full_span, double u0, double u1) : span(full_span), lo(u0), hi(u1) {
        std::array<std::pair<double, FanEdges>, 9> nodes;
        std::size_t count = 0;
        const auto f = [&](double u) {
            const OpenFan& fan = fans.fans(span.tau(u));
            nodes[count++] = {u, fan.edges};
            return span.slope(u) * fans(fan);
        };
        const TwoRules<FanSum> rules = by_two_rules(kronrod_7, f, lo, hi);
        fine = rules.fine;
        difference = rules.difference;
        spread = rules.spread;
        for (const double u : {1e-3, 1 - 1e-3})  // between an end of the span and the nearest node
            if (u > lo && u < hi) nodes[count++] = {u, fans.fans.edges_at(span.tau(u))};
        std::sort(nodes.begin(), nodes.begin() + count);
        for (std::size_t k = 0; k + 1 < count && !kink; ++k)
            if (nodes[k].second != nodes[k + 1].second) kink = Interval{nodes[k].first, nodes[k + 1].first};
    }

    /// Returns the expected error of the larger rule: smaller than that of the smaller rule by the factor by which the
    /// smaller one improves on the middle point.
    FanSum expected_difference() const {
        const auto error_of = [](double error, double coarser) {
            return std::fabs(error) * std::min(1.0, 4 * std::fabs(error) / std::max(std::fabs(coarser), 1e-300));
        };
        return {error_of(difference.diffuse, spread.diffuse), error_of(difference.lobe, spread.lobe), 0};
    }

    /// Returns where to cut it: at the first kink, else in the middle.
    double cut(AllFans& fans) const {
        if (!kink) return 0.5 * (lo + hi);
        Interval interval = *kink;
        const FanEdges start_edges = fans.edges_at(span.tau(interval.lo));
        for (int k = 0; k < 9; ++k) {  // the effect of the remainder is quadratic
            const double middle = 0.5 * (interval.lo + interval.hi);
            (fans.edges_at(span.tau(middle)) == start_edges ? interval.lo : interval.hi) = middle;
        }
        return interval.hi;
    }
};

constexpr int halvings = 14, first_halvings = 2;

/// The sum of panels, cut where their rules differ, and first at kinks, where a shadow's edge meets the light's; no
/// node may lie there.
struct Adaptive {
    const FansUnderLobe& fans;
    double tolerance = 0;  // for one panel, in the unit of `weigh`
    DiskIntegral sum{};

    void add(const Panel& panel, int depth = 0) {
        const FanSum error = panel.expected_difference();
        const bool is_good = fans.point.weigh({error.diffuse, error.lobe}) <= tolerance;
        if (depth == halvings || (is_good && !(panel.kink && depth < first_halvings))) {
            sum.diffuse += panel.fine.diffuse;
            sum.lobe += panel.fine.lobe;
            sum.diffuse_error += std::fabs(panel.difference.diffuse);
            sum.lobe_error += std::fabs(panel.difference.lobe) + panel.fine.inner;
            return;
        }
        const double cut = panel.cut(fans.fans);
        add(Panel(fans, panel.span, panel.lo, cut), depth + 1);
        add(Panel(fans, panel.span, cut, panel.hi), depth + 1);
    }
};

}  // namespace

DiskIntegral fan_by_fan(const DiskPoint& point, AllFans& fans) {
    const Vec3d d = middle_of(fans.light()) - point.x;
    const double open = disk_area(fans.light()) / dot(d, d);  // Lambert's part, approximately
    if (!(point.weigh({1, 1}) > 0)) return {};                // a black surface
    fans.rewind();
    const FansUnderLobe under_lobe{fans, point};
    const std::vector<FanCut>& cuts = fans.cuts();
    std::vector<Panel> panels;
    double total = 0.01 * point.weigh({std::min(open, 1.0), 0});
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        fans.look_between(cuts[k].tau, cuts[k + 1].tau);
        panels.emplace_back(under_lobe, Span{cuts[k], cuts[k + 1]}, 0, 1);
        total += point.weigh({panels.back().fine.diffuse, panels.back().fine.lobe});
    }
    constexpr double tolerance = 4e-5;
    Adaptive sum{under_lobe, tolerance * total};
    for (const Panel& panel : panels) {
        fans.look_between(panel.span.from.tau, panel.span.to.tau);
        sum.add(panel);
    }
    // Light that passes a slit between two bodies may lie between two fans.
    const double unseen = fans.bodies() > 1 ? 3e-5 : 0;
    sum.sum.diffuse_error += unseen * std::min(open, 1.0);
    sum.sum.lobe_error += unseen * sum.sum.lobe;
    return sum.sum;
}

// ---- A light is cut into half-planes about an axis, called fans, by their azimuth; if the light does not surround the
// axis, the azimuth runs as a sine, so that the integrand has no root at the ends. What is visible at a node is cached,
// because lobes of other exponents use the same nodes. Angles in radians.

namespace {

Azimuths azimuths_of(const Bodies::Any& body, Vec3d x, const Frame<double>& frame) {
    return std::visit([&](const auto& b) { return b.azimuths(x, frame); }, body);
}

/// Returns the frame about R; its t lies in the plane of incidence and points away from the surface.
Frame<double> frame_about_lobe(const DiskPoint& point) {
    const Vec3d r = mirror(point.wo);
    const Vec3d tangent = Vec3d{0, 0, 1} - r.z * r;
    const double size = std::sqrt(dot(tangent, tangent));
    if (!(size > 1e-12)) return frame_about(point.frame.to_world(r));
    const Vec3d n = point.frame.to_world(r), t = point.frame.to_world((1 / size) * tangent);
    return {t, cross(n, t), n};
}

Frame<double> frame_about_light(const DiskPoint& point, const Figure& light) {
    const Vec3d d = middle_of(light) - point.x;
    return frame_about((1 / std::sqrt(dot(d, d))) * d);
}

}  // namespace

AllFans::AllFans(const DiskPoint& point, const Figure& light, const std::vector<const Blocker*>& bodies,
    bool about_lobe, bool at_horizon)
    : point_(point),
      figure_(light),
      frame_(about_lobe ? frame_about_lobe(point) : frame_about_light(point, light)),
      about_lobe_(about_lobe),
      at_horizon_(at_horizon),
      light_(azimuths_of(body_of(light), point.x, frame_)) {
    for (const Blocker* body : bodies) bodies_.push_back({body, azimuths_of(body->body.body, point.x, frame_)});
    add_all_cuts();
}

double AllFans::azimuth_of(Vec3d d) const { return math::atan2(dot(d, frame_.b), dot(d, frame_.t)); }

AllFans::Turn AllFans::turn(double tau) const {
    if (light_.whole()) return {light_.middle + tau, 1};
    const auto [sin, cos] = math::sincos(tau);
    return {light_.middle + light_.half * sin, light_.half * cos};
}

void AllFans::cut(double phi, bool root) {
    const double distance = std::remainder(phi - light_.middle, 2 * pi);
    if (std::fabs(distance) < light_.half)
        cuts_.push_back({light_.whole() ? distance : math::asin(distance / light_.half), root});
}

/// For a body with corners, cuts where one lies before the light; for others, where they begin and end.
void AllFans::add_cuts(const Body& body) {
    const auto stands_before = [&](Vec3d d) {
        const double t = std::visit([&](const auto& light) { return light.intersect(point_.x, d).t; }, figure_);
        return t > 1 && t < never;
    };
    std::visit(
        [&](const auto& b) {
            if constexpr (requires { b.corners(); }) {
                for (const Vec3d corner : b.corners())
                    if (stands_before(corner - point_.x)) cut(azimuth_of(corner - point_.x), false);
            } else if (!body.azimuths.whole())
                for (const double end : {-body.azimuths.half, body.azimuths.half})
                    cut(body.azimuths.middle + end, true);
        },
        body.blocker->body.body);
}

void AllFans::add_all_cuts() {
    const int steps = light_.whole() ? 4 : 2;
    for (int k = 0; k <= steps; ++k) cuts_.push_back({last() * (2.0 * k / steps - 1), false});
    for (const Body& body : bodies_) add_cuts(body);
    if (std::holds_alternative<shapes::Quad>(figure_))
        for (const Vec3d corner : corners_about(figure_)) cut(azimuth_of(corner - point_.x), false);
    if (about_lobe_)
        for (const double middle : {0.0, pi}) {
            cut(middle, false);
            for (double distance = lobe_stretch(point_); distance < pi / 2; distance *= 3) {
                cut(middle - distance, false);
                cut(middle + distance, false);
            }
        }
    std::ranges::sort(cuts_, {}, &FanCut::tau);
    std::vector<FanCut> distinct_cuts;
    for (const FanCut& c : cuts_)
        if (!distinct_cuts.empty() && c.tau - distinct_cuts.back().tau <= 1e-14) distinct_cuts.back().root |= c.root;
        else distinct_cuts.push_back(c);
    cuts_ = std::move(distinct_cuts);
}

void AllFans::look_between(double lo, double hi) {
    blockers_.clear();
    const double from = turn(lo).azimuth, to = turn(hi).azimuth;
    for (const Body& body : bodies_)
        if (body.azimuths.whole() || body.azimuths.meet(from, to)) blockers_.push_back(body.blocker);
}

template <class F> FanEdges AllFans::each_open(const Fan& fan, F&& f) {
    FanEdges edges = 1;
    if (fan.empty) return edges;
    hidden_.clear();
    for (const Blocker* b : blockers_)
        for (const Interval& part :
            hidden(b->body, point_.x, point_.x + fan.to0, point_.x + (fan.to0 + fan.step), b->limits))
            hidden_.push_back(part);
    each_open_part(hidden_, [&](Interval open) {
        edges = 4 * edges + (open.lo > 0 ? 2 : 0) + (open.hi < 1 ? 1 : 0);
        f(open);
    });
    return edges;
}

OpenFan AllFans::look_at(double tau) {
    const Turn node = turn(tau);
    const math::SinCos azimuth = math::sincos(node.azimuth);
    const Fan fan(point_, figure_, frame_, azimuth);
    OpenFan out = {.axis = point_.frame.to_local(fan.axis),
        .side = point_.frame.to_local(fan.side),
        .cos_azimuth = azimuth.cos,
        .slope = node.slope};
    out.first_part = parts_.size();
    out.edges = each_open(fan, [&](Interval open) {
        Direction from = fan.at(open.lo), to = fan.at(open.hi);
        if (at_horizon_) fan.rise_above(point_, from, to);
        if (!(from.al < to.al)) return;
        out.diffuse += fan.lambert(point_, from, to) / pi;
        parts_.push_back({from.al, to.al});
    });
    out.parts = parts_.size() - out.first_part;
    return out;
}

const OpenFan& AllFans::operator()(double tau) {
    return fans_(tau, [&] { return look_at(tau); });
}

FanEdges AllFans::edges_at(double tau) {
    return edges_(
        tau, [&] { return each_open(Fan(point_, figure_, frame_, math::sincos(turn(tau).azimuth)), [](Interval) {}); });
}

}  // namespace crescent
