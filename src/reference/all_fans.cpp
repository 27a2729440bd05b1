#include "reference/all_fans.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"

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
      shape_(point),
      about_lobe_(about_lobe),
      at_horizon_(at_horizon),
      light_(azimuths_of(body_of(light), point.x, about_)) {
    for (const Blocker* body : bodies) bodies_.push_back({body, azimuths_of(body->body.body, point.x, about_)});
}

double AllFans::azimuth_of(Vec3d d) const { return math::atan2(dot(d, about_.b), dot(d, about_.t)); }

double AllFans::azimuth(double tau) const {
    return light_.middle + (light_.whole() ? tau : light_.half * math::sin(tau));
}

void AllFans::cut(double phi, bool root, std::vector<FanCut>& at) const {
    const double off = std::remainder(phi - light_.middle, 2 * pi);
    if (std::fabs(off) < light_.half) at.push_back({light_.whole() ? off : math::asin(off / light_.half), root});
}

/// Of a body with corners, where one stands before the light; of others, where they begin and end.
void AllFans::add_cuts(const Body& body, std::vector<FanCut>& at) const {
    const auto stands_before = [&](Vec3d d) {
        const double t = std::visit([&](const auto& light) { return light.intersect(point_.x, d).t; }, figure_);
        return t > 1 && t < never;
    };
    std::visit(
        [&](const auto& b) {
            if constexpr (requires { b.corners(); }) {
                for (const Vec3d corner : b.corners())
                    if (stands_before(corner - point_.x)) cut(azimuth_of(corner - point_.x), false, at);
            } else if (!body.azimuths.whole())
                for (const double end : {-body.azimuths.half, body.azimuths.half})
                    cut(body.azimuths.middle + end, true, at);
        },
        body.blocker->body.body);
}

std::vector<FanCut> AllFans::cuts() const {
    std::vector<FanCut> at;
    const int even = light_.whole() ? 4 : 2;
    for (int k = 0; k <= even; ++k) at.push_back({last() * (2.0 * k / even - 1), false});
    for (const Body& body : bodies_) add_cuts(body, at);
    if (std::holds_alternative<shapes::Quad>(figure_))
        for (const Vec3d corner : corners_about(figure_)) cut(azimuth_of(corner - point_.x), false, at);
    if (about_lobe_)
        for (double off = shape_.stretch; off < pi / 2; off *= 3)
            for (const double middle : {0.0, pi}) cut(middle - off, false, at), cut(middle + off, false, at);
    if (about_lobe_)
        for (const double middle : {0.0, pi}) cut(middle, false, at);
    std::ranges::sort(at, {}, &FanCut::tau);
    std::vector<FanCut> apart;
    for (const FanCut& c : at)
        if (!apart.empty() && c.tau - apart.back().tau <= 1e-14) apart.back().root |= c.root;
        else apart.push_back(c);
    return apart;
}

void AllFans::look_between(double lo, double hi) {
    near_.clear();
    for (const Body& body : bodies_)
        if (body.azimuths.whole() || body.azimuths.meet(azimuth(lo), azimuth(hi))) near_.push_back(body.blocker);
}

template <class F> void AllFans::each_open(const Fan& fan, F&& f) {
    edges_ = 1;
    if (fan.empty) return;
    hidden_.clear();
    for (const Blocker* b : near_)
        for (const Interval& part :
            hidden(b->body, point_.x, point_.x + fan.to0, point_.x + (fan.to0 + fan.step), b->between))
            hidden_.push_back(part);
    each_open_part(hidden_, [&](Interval open) {
        edges_ = 4 * edges_ + (open.lo > 0 ? 2 : 0) + (open.hi < 1 ? 1 : 0);
        f(open);
    });
}

FanSum AllFans::operator()(double tau) {
    const double phi = azimuth(tau);
    const Fan fan(point_, figure_, about_, phi);
    const bool lobe = point_.surface.rho_s > 0;
    const Vec3d axis = point_.frame.to_local(fan.axis), aside = point_.frame.to_local(fan.aside);
    const double width = about_lobe_ ? shape_.width_at(math::cos(phi)) : shape_.width;
    FanSum sum;
    each_open(fan, [&](Interval open) {
        Direction from = fan.at(open.lo), to = fan.at(open.hi);
        if (at_horizon_) fan.rise_above(point_, from, to);
        if (!(from.al < to.al)) return;
        sum.diffuse += fan.lambert(point_, from, to) / pi;
        const Interval part = {from.al, about_lobe_ ? std::min(to.al, shape_.reach) : to.al};
        if (!lobe || part.empty()) return;
        const AlongLobe along = lobe_along(point_, axis, aside, part, width);
        sum.lobe += along.value, sum.inner += along.error;
    });
    return light_.whole() ? sum : (light_.half * math::cos(tau)) * sum;
}

FanEdges AllFans::edges_at(double tau) {
    each_open(Fan(point_, figure_, about_, azimuth(tau)), [](Interval) {});
    return edges_;
}

}  // namespace crescent::inline reference
