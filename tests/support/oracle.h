// An independent reference for a pixel, for tests: plain Monte Carlo in double, with rays of its own. Draws
// cosine-weighted, from the lobe and on each disk, weighted by the balance heuristic (Veach 1997). Shares only lobes/
// with the quadrature.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <type_traits>
#include <vector>

#include "base/vec.h"
#include "scene/lobes/all.h"
#include "scene/scene.h"
#include "scene/scene_data.h"

namespace crescent::test {

/// Returns whether the surface of a body crosses x + t d for a t in (lo, hi).
struct Crosses {
    Vec3d x, d;
    double lo, hi;

    bool in(double t) const { return t > lo && t < hi; }
    double on_plane(Vec3d p, Vec3d n) const { return dot(n, d) == 0 ? -1 : dot(n, p - x) / dot(n, d); }

    bool operator()(const shapes::Sphere& o) const {
        const Vec3d c = o.center - x;
        const double foot = dot(c, d);
        const Vec3d off = c - foot * d;
        const double half2 = sqr(o.radius) - dot(off, off);
        return half2 > 0 && (in(foot - std::sqrt(half2)) || in(foot + std::sqrt(half2)));
    }
    bool operator()(const shapes::Box& o) const {
        double near = -1e300, far = 1e300;
        const auto slab = [&](double a, double b, double from, double v) {
            const double t0 = (a - from) / v, t1 = (b - from) / v;  // v = 0 has probability 0
            near = std::max(near, std::min(t0, t1));
            far = std::min(far, std::max(t0, t1));
        };
        slab(o.min.x, o.max.x, x.x, d.x);
        slab(o.min.y, o.max.y, x.y, d.y);
        slab(o.min.z, o.max.z, x.z, d.z);
        return near < far && (in(near) || in(far));
    }
    bool operator()(const shapes::Quad& o) const {
        const Vec3d n = cross(o.edge_u, o.edge_v);
        const double t = on_plane(o.corner, n);
        const Vec3d p = x + t * d - o.corner;
        const double u = dot(cross(p, o.edge_v), n) / dot(n, n), v = dot(cross(o.edge_u, p), n) / dot(n, n);
        return in(t) && u >= 0 && u <= 1 && v >= 0 && v <= 1;
    }
    bool operator()(const shapes::Disk& o) const {
        const double t = on_plane(o.center, o.normal);
        const Vec3d p = x + t * d - o.center;
        return in(t) && dot(p, p) <= sqr(o.radius);
    }
    bool operator()(const shapes::Plane& o) const { return in(on_plane(o.point, o.normal)); }
    /// A kind without a form here: where a camera ray from lo on meets it.
    bool operator()(const auto& o) const { return o.intersect(x + lo * d, d).t < hi - lo; }
};

struct Opinion {
    double y = 0, variance = 0, largest = 0;  // of the mean; the largest share of one sample in it
};

class Oracle {
public:
    Oracle(const Scene& scene, const Hit& hit, std::uint32_t seed)
        : scene_(scene),
          hit_(hit),
          surface_(scene.surface(hit)),
          frame_(frame_about(hit.n)),
          wo_(frame_.to_local(hit.wo)),
          next_(seed) {}

    /// `n` draws of each technique. Lambert under the fill is known; the rest is drawn.
    Opinion operator()(int n) {
        Opinion out;
        for (std::size_t k = 0; k < techniques(); ++k) {
            double mean = 0, square = 0;
            for (int j = 0; j < n; ++j) {
                const Direction drawn = draw(k);
                const double x = drawn.density > 0 ? drawn.worth / drawn.density : 0;
                mean += x / n;
                square += x * x / n;
                out.largest = std::max(out.largest, std::fabs(x) / n);
            }
            out.y += mean;
            out.variance += (square - mean * mean) / n;
        }
        out.y += pi * lambert_under_fill();
        return out;
    }

    /// A drawn direction, local: Y of f L cos there, except for Lambert under the fill; the sum of the techniques'
    /// densities, 1/sr, 0 if nothing was drawn.
    struct Direction {
        Vec3d wi{};
        double worth = 0, density = 0;
    };
    /// Technique 0: the cosine; 1: the lobe; 2 + k: light k.
    Direction draw(std::size_t technique) {
        if (technique == 1 && !(surface_.rho_s > 0)) return {};
        const Vec3d wi = technique == 0 ? cosine() : technique == 1 ? lobe() : on_light(technique - 2);
        const bool aimed_at =  // not the back of an area light
            technique < 2 || lit(scene_.lights()[technique - 2], frame_.to_world(wi)).t < 1e300;
        return aimed_at ? at(wi) : Direction{};
    }
    std::size_t techniques() const { return 2 + scene_.lights().size(); }
    /// Y of rho_d / pi under the fill.
    double lambert_under_fill() const {
        double out = 0;
        for (std::size_t c = 0; c < 3; ++c) out += luminance_weights[c] * surface_.rho_d[c] / pi * scene_.fill()[c];
        return out;
    }

private:
    double u() { return std::uniform_real_distribution<double>(0, 1)(next_); }
    static double pdf_of_half(double pdf_m, Vec3d wo, Vec3d m) { return pdf_m / (4 * std::fabs(dot(wo, m))); }

    Vec3d polar(double cos, double sin) {
        const double phi = 2 * pi * u();
        return {sin * std::cos(phi), sin * std::sin(phi), cos};
    }
    Vec3d cosine() {
        const double r2 = u();
        return polar(std::sqrt(1 - r2), std::sqrt(r2));
    }
    /// cos^k about the pole, without cancellation: 1 - cos^2 = -expm1(2 log(v) / (k + 1)).
    Vec3d power(double k) {
        const double log_cos = std::log(1 - u()) / (k + 1);
        return polar(std::exp(log_cos), std::sqrt(-std::expm1(2 * log_cos)));
    }
    Vec3d lobe() {
        if (surface_.brdf == lobe_named("phong")) return frame_about(mirror(wo_)).to_world(power(surface_.s));
        Vec3d m;
        if (surface_.brdf == lobe_named("blinn-phong")) m = power(surface_.s);
        else {
            const double v = u(), a2 = sqr(surface_.alpha);
            const double tan2 = surface_.brdf == lobe_named("beckmann") ? -a2 * std::log1p(-v) : a2 * v / (1 - v);
            const double cos = 1 / std::sqrt(1 + tan2);
            m = polar(cos, cos * std::sqrt(tan2));
        }
        return 2 * dot(wo_, m) * m - wo_;
    }
    double lobe_pdf(Vec3d wi) const {
        if (!(surface_.rho_s > 0)) return 0;
        const double s = surface_.s;
        if (surface_.brdf == lobe_named("phong")) return (s + 1) / (s + 2) * PhongLobe<double>(s, 0)(wo_, wi);
        const Vec3d sum = wo_ + wi, m = (1 / std::sqrt(dot(sum, sum))) * sum;
        if (surface_.brdf == lobe_named("blinn-phong"))
            return pdf_of_half((s + 1) / (2 * pi) * cosine_power(m, Vec3d{0, 0, 1}, s), wo_, m);
        if (surface_.brdf == lobe_named("beckmann"))
            return pdf_of_half(Beckmann<double>{surface_.alpha}.D(m) * m.z, wo_, m);
        return pdf_of_half(Ggx<double>{surface_.alpha}.D(m) * m.z, wo_, m);
    }
    Vec3d towards(Vec3d y) const {
        return frame_.to_local((1 / std::sqrt(dot(y - hit_.x, y - hit_.x))) * (y - hit_.x));
    }
    Vec3d on(const lights::Disk& disk) {
        const Vec3d p = polar(0, disk.radius * std::sqrt(u()));
        return towards(disk.center + frame_about(disk.normal).to_world(p));
    }
    Vec3d on(const lights::Sphere& ball) {  // anywhere on it
        const double z = 2 * u() - 1;
        return towards(ball.center + ball.radius * polar(z, std::sqrt(1 - z * z)));
    }
    Vec3d on(const lights::Rectangle& r) { return towards(r.corner + u() * r.edge_u + u() * r.edge_v); }
    /// A kind without a form here: on the figure of its outline.
    Vec3d on(const auto& light) {
        const auto among = [&]<class Figure>(const Figure& f) {
            if constexpr (std::is_same_v<Figure, shapes::Disk>) return on(lights::Disk{f.center, f.normal, f.radius});
            else return towards(f.corner + u() * f.edge_u + u() * f.edge_v);
        };
        return std::visit(among, light.seen_from(hit_.x));
    }
    Vec3d on_light(std::size_t k) {
        return std::visit([&](const auto& light) { return on(light); }, scene_.lights()[k].form);
    }

    /// Where a direction meets a light first, and the density in 1/sr of points drawn on it.
    struct Lit {
        double t = 1e300, pdf = 0;
    };
    /// A flat one.
    Lit flat(Vec3d d, Vec3d center, Vec3d normal, double radius, bool two_sided, double area, auto&& holds_it) const {
        const Vec3d c = center - hit_.x;
        const double along = dot(c, normal), v = dot(d, normal), t = along / v;
        if (std::fabs(along) <= 1e-6 * (std::sqrt(dot(c, c)) + radius) || !(t > 0)) return {};
        if ((along > 0 && !two_sided) || !holds_it(t * d - c)) return {};
        return {t, t * t / (std::fabs(v) * area)};
    }
    Lit lit(const lights::Disk& l, Vec3d d) const {
        return flat(d, l.center, l.normal, l.radius, l.two_sided, pi * sqr(l.radius),
            [&](Vec3d p) { return dot(p, p) <= sqr(l.radius) * (1 + 1e-12); });
    }
    Lit lit(const lights::Rectangle& l, Vec3d d) const {
        const double u2 = dot(l.edge_u, l.edge_u), v2 = dot(l.edge_v, l.edge_v);
        return flat(d, l.corner + 0.5 * (l.edge_u + l.edge_v), normalize(cross(l.edge_u, l.edge_v)),
            0.5 * std::sqrt(u2 + v2), l.two_sided, std::sqrt(u2 * v2), [&](Vec3d p) {
                return std::fabs(dot(p, l.edge_u)) <= 0.5 * u2 && std::fabs(dot(p, l.edge_v)) <= 0.5 * v2;
            });
    }
    Lit lit(const lights::Sphere& l, Vec3d d) const {
        const Vec3d c = l.center - hit_.x;
        const double foot = dot(c, d);
        const Vec3d off = c - foot * d;
        const double half2 = sqr(l.radius) - dot(off, off);
        if (!(half2 > 0) || !(foot > 0) || dot(c, c) <= sqr(l.radius)) return {};
        const double half = std::sqrt(half2), cos = half / l.radius, area = 4 * pi * sqr(l.radius);
        return {foot - half, (sqr(foot - half) + sqr(foot + half)) / (cos * area)};  // both of its sides are drawn
    }
    Lit lit(const auto& light, Vec3d d) const {
        if (!light.shines_on(hit_.x)) return {};
        const Figure figure = light.seen_from(hit_.x);
        const auto holds_it = [&](Vec3d p) {  // p from its middle
            const Vec3d n = normal_of(figure);
            return std::visit(Crosses{middle_of(figure) + p - n, n, 0, 2}, body_of(figure));
        };
        return flat(d, middle_of(figure), normal_of(figure), radius_of(figure), true, pi * disk_area(figure), holds_it);
    }
    Lit lit(const Light& light, Vec3d d) const {
        return std::visit([&](const auto& form) { return lit(form, d); }, light.form);
    }
    Direction at(Vec3d wi) const {
        if (!(wi.z > 0)) return {};
        const Vec3d d = frame_.to_world(wi);
        double pdf = wi.z / pi + lobe_pdf(wi), nearest = 1e300;
        const Light* met = nullptr;
        for (const Light& light : scene_.lights()) {
            const auto [t, density] = lit(light, d);
            pdf += density;
            if (t < nearest * (1 - 1e-5)) {
                nearest = t;
                met = &light;
            }
        }
        for (const Occluder& o : scene_.occluders())
            if (met && o.shape != hit_.shape &&
                std::visit(Crosses{hit_.x, d, 1e-5 * nearest, (1 - 1e-5) * nearest}, o.body))
                met = nullptr;
        const double lobe = surface_.rho_s > 0 ? lobe_of(wi) : 0;
        double x = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double fill = scene_.fill()[c], over = met ? met->radiance[c] - fill : 0;
            x += luminance_weights[c] *
                (surface_.rho_d[c] / pi * over + surface_.rho_s * surface_.tint[c] * lobe * (over + fill));
        }
        return {wi, x * wi.z, pdf};
    }
    double lobe_of(Vec3d wi) const { return lobe_value(surface_.brdf, surface_.s, surface_.alpha, wo_, wi); }

    const Scene& scene_;
    const Hit& hit_;
    Surface surface_;
    Frame<double> frame_;
    Vec3d wo_;
    std::mt19937_64 next_;
};

}  // namespace crescent::test
