#include "reference/fans.h"

#include <algorithm>
#include <cmath>

#include "reference/fan.h"
#include "reference/kronrod.h"
#include "reference/lobe_along.h"
#include "math/functions.h"

namespace crescent::inline reference {

namespace {

Azimuths azimuths_of(const Bodies::Any& body, Vec3d x, const Frame<double>& frame) {
    return std::visit([&](const auto& b) { return b.azimuths(x, frame); }, body);
}

/// What fans add up to: both parts, and the error of the lobe's rule along them.
struct Sum {
    double diffuse = 0, lobe = 0, inner = 0;
    friend Sum operator+(Sum a, Sum b) { return {a.diffuse + b.diffuse, a.lobe + b.lobe, a.inner + b.inner}; }
    friend Sum operator-(Sum a, Sum b) { return {a.diffuse - b.diffuse, a.lobe - b.lobe, a.inner - b.inner}; }
    friend Sum operator*(double k, Sum a) { return {k * a.diffuse, k * a.lobe, k * a.inner}; }
};

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

/// All fans that meet the light, by a parameter tau in which the fans' integral is smooth where the light is a disk
/// and open: the azimuth itself where the axis meets it; else middle + half sin(tau), as chords grow from a tangent
/// like a root.
class Fans {
public:
    Fans(const DiskPoint& point, const Figure& light, const std::vector<const Blocker*>& bodies, bool about_lobe,
        bool at_horizon)
        : point_(point),
          figure_(light),
          about_(about_lobe ? frame_about_lobe(point) : frame_about_light(point, light)),
          shape_(point),
          about_lobe_(about_lobe),
          at_horizon_(at_horizon),
          light_(azimuths_of(body_of(light), point.x, about_)) {
        for (const Blocker* body : bodies) bodies_.push_back({body, azimuths_of(body->body.body, point.x, about_)});
    }

    double last() const { return light_.whole() ? pi : pi / 2; }  // tau runs from -last() to last()

    /// Where panels must end.
    std::vector<double> cuts() const {
        std::vector<double> at;
        const int even = light_.whole() ? 4 : 2;
        for (int k = 0; k <= even; ++k) at.push_back(last() * (2.0 * k / even - 1));
        for (const Body& body : bodies_)
            if (!body.azimuths.whole())
                for (const double end : {-body.azimuths.half, body.azimuths.half}) cut(body.azimuths.middle + end, at);
        if (std::holds_alternative<shapes::Quad>(figure_))
            for (const Vec3d corner : corners_about(figure_)) cut(azimuth_of(corner - point_.x), at);
        if (about_lobe_)
            for (double off = shape_.stretch; off < pi / 2; off *= 3)
                for (const double middle : {0.0, pi}) cut(middle - off, at), cut(middle + off, at);
        if (about_lobe_)
            for (const double middle : {0.0, pi}) cut(middle, at);
        std::sort(at.begin(), at.end());
        return at;
    }

    /// The bodies that fans between two tau may meet: the next calls look at no others.
    void look_between(double lo, double hi) {
        near_.clear();
        for (const Body& body : bodies_)
            if (body.azimuths.whole() || body.azimuths.meet(azimuth(lo), azimuth(hi))) near_.push_back(body.blocker);
    }

    /// One fan, times what turns d tau into an azimuth.
    Sum operator()(double tau) {
        const double phi = azimuth(tau);
        const Fan fan(point_, figure_, about_, phi);
        if (fan.empty) return {};
        hidden_.clear();
        for (const Blocker* b : near_)
            for (const Interval& part :
                hidden(b->body, point_.x, point_.x + fan.to0, point_.x + (fan.to0 + fan.step), b->between))
                hidden_.push_back(part);
        const bool lobe = point_.surface.rho_s > 0;
        const Vec3d axis = point_.frame.to_local(fan.axis), aside = point_.frame.to_local(fan.aside);
        const double width = about_lobe_ ? shape_.width_at(math::cos(phi)) : shape_.width;
        Sum sum;
        each_open_part(hidden_, [&](Interval open) {
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

private:
    struct Body {
        const Blocker* blocker;
        Azimuths azimuths;
    };
    double azimuth_of(Vec3d d) const { return math::atan2(dot(d, about_.b), dot(d, about_.t)); }
    double azimuth(double tau) const { return light_.middle + (light_.whole() ? tau : light_.half * math::sin(tau)); }
    void cut(double phi, std::vector<double>& at) const {
        const double off = std::remainder(phi - light_.middle, 2 * pi);
        if (std::fabs(off) < light_.half) at.push_back(light_.whole() ? off : math::asin(off / light_.half));
    }

    const DiskPoint& point_;
    const Figure& figure_;
    Frame<double> about_;
    LobeShape shape_;
    bool about_lobe_, at_horizon_;
    Azimuths light_;
    std::vector<Body> bodies_;
    std::vector<const Blocker*> near_;
    std::vector<Interval> hidden_;
};

/// Two rules over a part of the fans between two cuts: the integral, and how far the smaller rule is from it.
/// Where a round body begins or ends its shadow opens like a root: tau = from + width u^2 (3 - 2u) smooths both ends.
struct Panel {
    double from, width;  // in tau, between the cuts
    double lo, hi;       // in u
    Sum fine, off;

    Panel(Fans& fans, double cut, double size, double u0, double u1) : from(cut), width(size), lo(u0), hi(u1) {
        const auto f = [&](double u) { return (6 * width * u * (1 - u)) * fans(from + width * u * u * (3 - 2 * u)); };
        const TwoRules<Sum> both = by_two_rules(kronrod_7, f, lo, hi);
        fine = both.fine, off = both.off;
    }
};

/// The sum of panels, halved where their rules differ: kinks, where a shadow's edge meets the disk's, are closed in
/// upon.
struct Adaptive {
    Fans& fans;
    const DiskPoint& point;
    double tolerance = 0;  // of one panel, in the unit of `weigh`
    DiskIntegral sum{};

    void add(const Panel& panel, int halvings) {
        if (halvings == 0 || point.weigh({panel.off.diffuse, panel.off.lobe}) <= tolerance) {
            sum.diffuse += panel.fine.diffuse, sum.lobe += panel.fine.lobe;
            sum.diffuse_error += std::fabs(panel.off.diffuse),
                sum.lobe_error += std::fabs(panel.off.lobe) + panel.fine.inner;
            return;
        }
        const double middle = 0.5 * (panel.lo + panel.hi);
        add(Panel(fans, panel.from, panel.width, panel.lo, middle), halvings - 1);
        add(Panel(fans, panel.from, panel.width, middle, panel.hi), halvings - 1);
    }
};

}  // namespace

DiskIntegral fan_by_fan(const DiskPoint& point, const Figure& light, const std::vector<const Blocker*>& bodies,
    bool about_lobe, bool at_horizon) {
    const Vec3d d = middle_of(light) - point.x;
    const double open = disk_area(light) / dot(d, d);  // Lambert's, about
    if (!(point.weigh({1, 1}) > 0)) return {};         // a black surface
    Fans fans(point, light, bodies, about_lobe, at_horizon);
    const std::vector<double> cuts = fans.cuts();
    std::vector<Panel> panels;
    double all = 0.01 * point.weigh({std::min(open, 1.0), 0});
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        if (!(cuts[k + 1] - cuts[k] > 1e-14)) continue;
        fans.look_between(cuts[k], cuts[k + 1]);
        panels.emplace_back(fans, cuts[k], cuts[k + 1] - cuts[k], 0, 1);
        all += point.weigh({panels.back().fine.diffuse, panels.back().fine.lobe});
    }
    constexpr double tolerance = 4e-5;
    constexpr int halvings = 14;
    Adaptive sum{fans, point, tolerance * all};
    for (const Panel& panel : panels) {
        fans.look_between(panel.from, panel.from + panel.width);
        sum.add(panel, halvings);
    }
    // Light that falls through a slit between two bodies may fall between two fans.
    const double unseen = bodies.size() > 1 ? 3e-5 : 0;
    sum.sum.diffuse_error += unseen * std::min(open, 1.0), sum.sum.lobe_error += unseen * sum.sum.lobe;
    return sum.sum;
}

}  // namespace crescent::inline reference
