#include "estimator/chords.h"

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "scene/shadow.h"

namespace crescent {

namespace {

/// The lobe along one open part of a chord.
template <unsigned n> double lobe_along(const DiskPoint& point, Vec3d y0, Vec3d step, Interval part) {
    return boost::math::quadrature::gauss<double, n>::integrate([&](double v) { return point.lobe_at(y0 + v * step); }, part.lo, part.hi);
}
double lobe_along(const DiskPoint& point, Vec3d y0, Vec3d step, Interval part, double sharpness) {
    if (sharpness < 1) return lobe_along<10>(point, y0, step, part);
    if (sharpness < 4) return lobe_along<20>(point, y0, step, part);
    return lobe_along<60>(point, y0, step, part);
}

/// A chord seen from x: integral of cos(theta_i) cos(theta_l) / r^2 dv in closed form. Along it n.d is linear in v, the
/// height over the disk's plane is constant and r^2 quadratic: with w the distance to the foot of the perpendicular and
/// q its square, the integrand is (a + b w) h / (w^2 + q)^2.
class LambertChord {
public:
    LambertChord(const DiskPoint& point, Vec3d y0, Vec3d step) : length_(length(step)) {
        const Vec3d d = y0 - point.x, e = step * (1 / length_);
        foot_ = dot(d, e);
        q_ = dot(d, d) - sqr(foot_);
        b_ = dot(point.frame.n, e);
        a_ = dot(point.frame.n, d) - foot_ * b_;
        height_ = std::fabs(dot(d, point.light_normal));
    }
    double operator()(Interval part) const {
        const double w0 = foot_ + part.lo * length_, w1 = foot_ + part.hi * length_;
        const double r0 = sqr(w0) + q_, r1 = sqr(w1) + q_, root = std::sqrt(q_);
        const double angle = std::atan2((w1 - w0) * root, q_ + w0 * w1) / root;
        return 0.5 * height_ / length_ * (b_ * (1 / r0 - 1 / r1) + a_ / q_ * (w1 / r1 - w0 / r0 + angle));
    }

private:
    double length_, foot_, q_, a_, b_, height_;
};

/// Chord by chord: on each, the exact open parts.
class Chords {
public:
    Chords(const DiskPoint& point, const DiskLight& disk, const Frame<double>& frame, const std::vector<const Occluder*>& bodies)
        : point_(point), disk_(disk), frame_(frame), bodies_(bodies), sharpness_(point.sharpness(disk.radius / length(disk.center - point.x))) {}

    /// The chord at height R sin(phi), times what turns d phi into area.
    Parts operator()(double phi) {
        const double half = disk_.radius * std::cos(phi);
        const Vec3d middle = disk_.center + frame_.b * (disk_.radius * std::sin(phi));
        const Vec3d y0 = middle - frame_.t * half, y1 = middle + frame_.t * half;
        const double h0 = dot(point_.frame.n, y0 - point_.x), h1 = dot(point_.frame.n, y1 - point_.x);
        if (h0 <= 0 && h1 <= 0) return 0;
        parts_.clear();
        for (const Occluder* body : bodies_) parts_.push_back(hidden(*body, point_.x, y0, y1));
        if (h0 < 0) parts_.push_back({0, h0 / (h0 - h1)});
        if (h1 < 0) parts_.push_back({h0 / (h0 - h1), 1});
        const LambertChord lambert(point_, y0, y1 - y0);
        double diffuse = 0, lobe = 0;
        each_open_part(parts_, [&](Interval part) {
            diffuse += lambert(part) / pi;
            if (point_.surface.rho_s > 0) lobe += lobe_along(point_, y0, y1 - y0, part, sharpness_);
        });
        return Parts(diffuse, lobe) * (2 * half * half);  // chord length x R cos(phi)
    }

private:
    const DiskPoint& point_;
    const DiskLight& disk_;
    const Frame<double>& frame_;
    const std::vector<const Occluder*>& bodies_;
    double sharpness_;
    std::vector<Interval> parts_;
};

/// Integral over [lo, hi] by Gauss-Kronrod (3, 7), halved where the two differ: kinks, where a shadow's edge meets the
/// disk's, are closed in upon.
struct Adaptive {
    double tolerance;  // of one interval, in the unit of `weigh`
    Parts value = 0, error = 0;

    template <class F, class Weigh> void add(F& f, const Weigh& weigh, double lo, double hi, int depth) {
        constexpr std::array<double, 3> x = {0.43424374934680256, 0.77459666924148338, 0.96049126870802028};
        constexpr std::array<double, 4> kronrod = {0.45091653865847414, 0.40139741477596222, 0.26848808986833344, 0.10465622602646727};
        const double middle = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
        const auto both = [&](double t) { return f(middle - half * t) + f(middle + half * t); };
        const Parts f0 = f(middle), f2 = both(x[1]);
        const Parts fine = half * (kronrod[0] * f0 + kronrod[1] * both(x[0]) + kronrod[2] * f2 + kronrod[3] * both(x[2]));
        const Parts coarse = half * (8.0 / 9 * f0 + 5.0 / 9 * f2), off = fine - coarse;
        if (depth == 0 || weigh(off) <= tolerance) {
            value += fine;
            error += Parts(std::fabs(off.real()), std::fabs(off.imag()));
            return;
        }
        add(f, weigh, lo, middle, depth - 1);
        add(f, weigh, middle, hi, depth - 1);
    }
};

}  // namespace

DiskIntegral chord_by_chord(const DiskPoint& point, const DiskLight& disk, const Frame<double>& frame, const std::vector<const Occluder*>& bodies) {
    const double open = sqr(disk.radius) / dot(disk.center - point.x, disk.center - point.x);  // Lambert's, about
    const auto weigh = [&](Parts p) { return point.weigh(p); };
    const double all = weigh({open, open});
    if (!(all > 0)) return {};  // a black surface
    Chords chords(point, disk, frame, bodies);
    const int panels = bodies.empty() ? 4 : 12;  // slivers of shadow hide between the nodes of wide panels
    constexpr int halvings = 14;
    Adaptive sum{1e-6 * all};
    for (int k = 0; k < panels; ++k) sum.add(chords, weigh, pi * k / panels - pi / 2, pi * (k + 1) / panels - pi / 2, halvings);
    // A sliver of shadow between the nodes of a panel is not seen: 3e-5 of the open disk is more than was ever missed.
    constexpr double unseen = 3e-5;
    return {sum.value.real(), sum.value.imag(), sum.error.real() + unseen * open, sum.error.imag() + unseen * std::fabs(sum.value.imag())};
}

}  // namespace crescent
