#include "estimator/disk_quadrature.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <complex>

#include "films/film.h"
#include "scene/brdf.h"

namespace crescent {

namespace {

using Pair = std::complex<double>;  // diffuse, lobe: two integrands in one pass

/// What one surface point makes of a direction to the disk.
struct Point {
    Vec3d x, wo;
    Frame<double> frame;
    Surface surface;
    Vec3d light_normal;

    /// f cos(theta_i) cos(theta_l) / r^2 at y, 1/m^2, rho apart.
    Pair operator()(Vec3d y) const {
        const Vec3d d = y - x;
        const double r2 = dot(d, d), r = std::sqrt(r2);
        const Vec3d wi = frame.to_local(d * (1 / r));
        if (wi.z <= 0) return 0;
        const double geometry = wi.z * std::fabs(dot(d, light_normal)) / (r * r2);
        return {geometry / pi, surface.rho_s > 0 ? geometry * lobe(wi) : 0.0};
    }
    double lobe(Vec3d wi) const {
        switch (surface.brdf) {
            case BrdfKind::phong: return PhongLobe<double>(surface.s, surface.alpha)(wo, wi);
            case BrdfKind::blinn_phong: return BlinnPhongLobe<double>(surface.s, surface.alpha)(wo, wi);
            case BrdfKind::ggx: return GgxLobe<double>(surface.s, surface.alpha)(wo, wi);
        }
        return 0;
    }
    /// How many times the lobe's width goes into the angle t: decides how fine a rule must be.
    double sharpness(double t) const {
        if (!(surface.rho_s > 0)) return 0;
        const double s = surface.brdf == BrdfKind::ggx ? 2 / sqr(surface.alpha) : surface.s;
        return t * std::sqrt(s);
    }
    /// Y of what the pair is worth under light of radiance 1.
    double weigh(Pair p) const { return luminance(surface.rho_d) * std::abs(p.real()) + surface.rho_s * std::abs(p.imag()); }
};

/// Gauss-Legendre in r^2, evenly spaced in angle: nodes on the unit disk, weights summing to pi.
struct PolarRule {
    struct Node {
        double x, y, weight;
    };
    std::vector<Node> nodes;

    template <unsigned radial> static PolarRule make(int angular) {
        PolarRule rule;
        using G = boost::math::quadrature::gauss<double, radial>;
        const auto ring = [&](double abscissa, double weight) {
            const double r = std::sqrt(0.5 * (1 + abscissa));
            for (int k = 0; k < angular; ++k) {
                const double phi = 2 * pi * (k + 0.5) / angular;
                rule.nodes.push_back({r * std::cos(phi), r * std::sin(phi), 0.5 * weight * pi / angular});
            }
        };
        for (std::size_t k = 0; k < G::abscissa().size(); ++k) {
            ring(G::abscissa()[k], G::weights()[k]);
            if (G::abscissa()[k] != 0) ring(-G::abscissa()[k], G::weights()[k]);
        }
        return rule;
    }
};

const std::vector<PolarRule>& polar_rules() {
    static const std::vector<PolarRule> rules = {PolarRule::make<2>(5),   PolarRule::make<3>(7),   PolarRule::make<5>(12),  PolarRule::make<7>(17),
                                                 PolarRule::make<10>(25), PolarRule::make<15>(36), PolarRule::make<25>(60), PolarRule::make<40>(96)};
    return rules;
}

DiskIntegral result(Pair value, Pair error) { return {value.real(), value.imag(), std::abs(error.real()), std::abs(error.imag())}; }

/// The whole disk is above the horizon and open, Lambert: integral of cos(theta_i) dw / pi in closed form. The light's
/// vector irradiance has a part along the disk's axis and a part towards it (Howell's catalog of view factors, elements
/// parallel and perpendicular to a disk), written without cancellation.
double whole_disk_diffuse(const Point& point, const DiskLight& disk) {
    const Vec3d d = disk.center - point.x;
    const double along = dot(d, disk.normal), r2 = sqr(disk.radius), h = std::fabs(along);
    const Vec3d axis = along < 0 ? -disk.normal : disk.normal;
    const Vec3d aside = d - h * axis;
    const double p2 = dot(aside, aside), a = p2 + h * h + r2;
    const double root = std::sqrt(a * a - 4 * r2 * p2);
    const double parallel = r2 * (1 - 2 * p2 / (a + root)) / root;
    return dot(point.frame.n, axis) * parallel + dot(point.frame.n, aside) * (2 * h * r2 / (root * (a + root)));
}

/// The same for the lobe: polar rules of rising order until two agree.
DiskIntegral whole_disk(const Point& point, const DiskLight& disk, const Frame<double>& frame) {
    DiskIntegral out;
    out.diffuse = whole_disk_diffuse(point, disk);
    if (!(point.surface.rho_s > 0)) return out;
    const auto apply = [&](const PolarRule& rule) {
        double sum = 0;
        for (const auto& n : rule.nodes) sum += n.weight * point(disk.center + frame.t * (disk.radius * n.x) + frame.b * (disk.radius * n.y)).imag();
        return sum * sqr(disk.radius);
    };
    constexpr double good = 1e-6;  // relative, between two rules; the finer one, which is kept, is better by far
    const auto& rules = polar_rules();
    double coarse = apply(rules[0]);
    for (std::size_t k = 1; k < rules.size(); ++k) {
        out.lobe = apply(rules[k]);
        out.lobe_error = std::fabs(out.lobe - coarse);
        if (point.weigh({0, out.lobe_error}) <= good * point.weigh({out.diffuse, out.lobe})) break;
        coarse = out.lobe;
    }
    return out;
}

template <unsigned n> Pair along(const Point& point, Vec3d y0, Vec3d y1, Interval part) {
    const auto f = [&](double v) { return point(y0 + v * (y1 - y0)); };
    return boost::math::quadrature::gauss<double, n>::integrate(f, part.lo, part.hi);
}

Pair along(const Point& point, Vec3d y0, Vec3d y1, Interval part, double sharpness) {
    if (sharpness == 0) return along<5>(point, y0, y1, part);
    if (sharpness < 1) return along<10>(point, y0, y1, part);
    if (sharpness < 4) return along<20>(point, y0, y1, part);
    return along<60>(point, y0, y1, part);
}

}  // namespace

DiskQuadrature::DiskQuadrature(const Scene& scene, std::size_t k)
    : disk_(scene.disks()[k]), frame_(frame_about(scene.disks()[k].normal)), bodies_(scene.occluders()) {
    for (std::size_t other = 0; other < scene.disks().size(); ++other) {
        const DiskLight& d = scene.disks()[other];
        if (other != k) bodies_.push_back({Occluder::Kind::disk, -2 - static_cast<int>(d.two_sided), d.center, d.normal, {}, d.radius});
    }
    for (const Occluder& body : bodies_) bounds_.push_back(bound_of(body));
}

namespace {

/// Does one body hide the whole disk? Its shadow on the disk's plane is convex: if two opposite sides of the square
/// around the disk lie in it, so does all between them.
bool hides_all(const Occluder& body, Vec3d x, const DiskLight& disk, const Frame<double>& frame) {
    const Vec3d side = disk.radius * frame.t, up = disk.radius * frame.b;
    const auto whole = [&](Vec3d middle) {
        const Interval part = hidden(body, x, middle - side, middle + side);
        return part.lo <= 0 && part.hi >= 1;
    };
    return whole(disk.center + up) && whole(disk.center - up);
}

/// Chord by chord: on each, the exact open parts; across them, adaptive Gauss-Kronrod, which finds the kinks.
DiskIntegral chord_by_chord(const Point& point, const DiskLight& disk, const Frame<double>& frame, const std::vector<const Occluder*>& bodies) {
    const double sharpness = point.sharpness(disk.radius / length(disk.center - point.x));
    const auto chord = [&](double phi) {
        const double half = disk.radius * std::cos(phi);
        const Vec3d middle = disk.center + frame.b * (disk.radius * std::sin(phi));
        const Vec3d y0 = middle - frame.t * half, y1 = middle + frame.t * half;
        std::vector<Interval> parts;
        for (const Occluder* body : bodies) parts.push_back(hidden(*body, point.x, y0, y1));
        const double h0 = dot(point.frame.n, y0 - point.x), h1 = dot(point.frame.n, y1 - point.x);
        if (h0 <= 0 && h1 <= 0) return Pair(0);
        if (h0 < 0) parts.push_back({0, h0 / (h0 - h1)});
        if (h1 < 0) parts.push_back({h0 / (h0 - h1), 1});
        Pair sum = 0;
        for (const Interval& part : open_parts(std::move(parts))) sum += along(point, y0, y1, part, sharpness);
        return sum * (2 * half * half);  // chord length x R cos(phi)
    };
    double error = 0;
    const Pair value = boost::math::quadrature::gauss_kronrod<double, 15>::integrate(chord, -pi / 2, pi / 2, 7, 1e-5, &error);
    return result(value, Pair(error, error));
}

}  // namespace

DiskIntegral DiskQuadrature::operator()(const Hit& hit, const Surface& surface) const {
    const double c = dot(disk_.center - hit.x, disk_.normal);
    if (!(c < 0 || (disk_.two_sided && c > 0))) return {};
    const double height = dot(disk_.center - hit.x, hit.n), tilt = dot(hit.n, disk_.normal);
    const double reach = disk_.radius * std::sqrt(std::max(0.0, 1 - tilt * tilt));
    if (height + reach <= 0) return {};
    const Frame<double> local = frame_about(hit.n);
    const Point point = {hit.x, local.to_local(hit.wo), local, surface, disk_.normal};
    std::vector<const Occluder*> near;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const Occluder& body = bodies_[k];
        const bool light_from_behind = body.shape == -2 && dot(body.a - hit.x, body.b) >= 0;
        if (body.shape != hit.shape && !light_from_behind && may_hide(bounds_[k], hit.x, disk_.center, disk_.radius)) near.push_back(&body);
    }
    for (const Occluder* body : near)
        if (hides_all(*body, hit.x, disk_, frame_)) return {};
    if (near.empty() && height - reach > 0) return whole_disk(point, disk_, frame_);
    return chord_by_chord(point, disk_, frame_, near);
}

}  // namespace crescent
