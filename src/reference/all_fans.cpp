// A light is cut into half-planes about an axis, fans, by their azimuth. Where the light does not surround the axis the
// azimuth runs as a sine, so that the integrand has no root at the ends. What is seen at a node is kept: lobes of other
// exponents ask for the same ones. Angles in radians.
#include "reference/all_fans.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "reference/lobe_along.h"

namespace crescent::inline reference {

namespace {

Azimuths azimuths_of(const Bodies::Any& body, Vec3d x, const Frame<double>& frame) {
    return std::visit([&](const auto& b) { return b.azimuths(x, frame); }, body);
}

/// The frame about R, its t in the plane of incidence, away from the surface.
Frame<double> frame_about_lobe(const DiskPoint& point) {
    const Vec3d r = mirror(point.wo);
    const Vec3d up = Vec3d{0, 0, 1} - r.z * r;
    const double size = std::sqrt(dot(up, up));
    if (!(size > 1e-12)) return frame_about(point.frame.to_world(r));
    const Vec3d n = point.frame.to_world(r), t = point.frame.to_world((1 / size) * up);
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
      about_(about_lobe ? frame_about_lobe(point) : frame_about_light(point, light)),
      about_lobe_(about_lobe),
      at_horizon_(at_horizon),
      light_(azimuths_of(body_of(light), point.x, about_)) {
    for (const Blocker* body : bodies) bodies_.push_back({body, azimuths_of(body->body.body, point.x, about_)});
    add_all_cuts();
}

double AllFans::azimuth_of(Vec3d d) const { return math::atan2(dot(d, about_.b), dot(d, about_.t)); }

AllFans::Turn AllFans::turn(double tau) const {
    if (light_.whole()) return {light_.middle + tau, 1};
    const auto [sin, cos] = math::sincos(tau);
    return {light_.middle + light_.half * sin, light_.half * cos};
}

void AllFans::cut(double phi, bool root) {
    const double off = std::remainder(phi - light_.middle, 2 * pi);
    if (std::fabs(off) < light_.half) cuts_.push_back({light_.whole() ? off : math::asin(off / light_.half), root});
}

/// Of a body with corners, where one stands before the light; of others, where they begin and end.
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
    const int even = light_.whole() ? 4 : 2;
    for (int k = 0; k <= even; ++k) cuts_.push_back({last() * (2.0 * k / even - 1), false});
    for (const Body& body : bodies_) add_cuts(body);
    if (std::holds_alternative<shapes::Quad>(figure_))
        for (const Vec3d corner : corners_about(figure_)) cut(azimuth_of(corner - point_.x), false);
    if (about_lobe_)
        for (const double middle : {0.0, pi}) {
            cut(middle, false);
            for (double off = lobe_stretch(point_); off < pi / 2; off *= 3)
                cut(middle - off, false), cut(middle + off, false);
        }
    std::ranges::sort(cuts_, {}, &FanCut::tau);
    std::vector<FanCut> apart;
    for (const FanCut& c : cuts_)
        if (!apart.empty() && c.tau - apart.back().tau <= 1e-14) apart.back().root |= c.root;
        else apart.push_back(c);
    cuts_ = std::move(apart);
}

void AllFans::look_between(double lo, double hi) {
    near_.clear();
    const double from = turn(lo).azimuth, to = turn(hi).azimuth;
    for (const Body& body : bodies_)
        if (body.azimuths.whole() || body.azimuths.meet(from, to)) near_.push_back(body.blocker);
}

template <class F> FanEdges AllFans::each_open(const Fan& fan, F&& f) {
    FanEdges edges = 1;
    if (fan.empty) return edges;
    hidden_.clear();
    for (const Blocker* b : near_)
        for (const Interval& part :
            hidden(b->body, point_.x, point_.x + fan.to0, point_.x + (fan.to0 + fan.step), b->between))
            hidden_.push_back(part);
    each_open_part(hidden_, [&](Interval open) {
        edges = 4 * edges + (open.lo > 0 ? 2 : 0) + (open.hi < 1 ? 1 : 0);
        f(open);
    });
    return edges;
}

OpenFan AllFans::look_at(double tau) {
    const Turn at = turn(tau);
    const math::SinCos azimuth = math::sincos(at.azimuth);
    const Fan fan(point_, figure_, about_, azimuth);
    OpenFan out = {point_.frame.to_local(fan.axis), point_.frame.to_local(fan.aside), azimuth.cos, at.slope};
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
        tau, [&] { return each_open(Fan(point_, figure_, about_, math::sincos(turn(tau).azimuth)), [](Interval) {}); });
}

}  // namespace crescent::inline reference
