// Densities about an axis, with and without jumps: cosine powers, cones, bands, polygonal lights, phase functions,
// mixtures.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "math/simd/frame.h"
#include "tests/known_samplers/correct/right.h"

namespace crescent {

Vec3d about(Vec3d axis, double cos, double turns) {
    return frame_about(axis).to_world(math::spherical(cos, 2 * pi * turns));
}

namespace {

/// c(u): cosine to the axis, p(c): density per solid angle; both for one lobe about `axis`.
struct Lobe {
    Vec3d axis;
    std::function<double(double u)> cos;
    std::function<double(double cos)> density;
};

/// Draws below the horizon return no sample if `clipped`; then the density there is 0 and the rest is not renormalised.
SyntheticSampler of_lobe(std::string family, std::string parameters, Lobe lobe, bool clipped = false) {
    SyntheticSampler r{std::move(family), std::move(parameters), {}, {}, {}};
    const auto pdf = [lobe, clipped](
                         Vec3d, Vec3d wi) { return clipped && wi.z <= 0 ? 0.0 : lobe.density(dot(wi, lobe.axis)); };
    r.pdf = pdf;
    r.sample = [lobe, pdf](Vec3d wo, Vec2d u) {
        const Vec3d wi = about(lobe.axis, lobe.cos(u.x), u.y);
        return Draw{wi, pdf(wo, wi), {}, {}};
    };
    return r;
}

Lobe power(Vec3d axis, double s) {
    return {axis, [s](double u) { return math::pow(u, 1 / (s + 1)); },
        [s](double c) { return c > 0 ? (s + 1) / (2 * pi) * math::pow(std::min(c, 1.0), s) : 0.0; }};
}
/// Uniform in solid angle from cos `low` to cos `high`. The edge itself has a rounding tolerance, because draws reach
/// it.
Lobe band(Vec3d axis, double low, double high) {
    return {axis, [low, high](double u) { return high + (low - high) * u; },
        [low, high](double c) { return c >= low - 1e-14 && c <= high + 1e-14 ? 1 / (2 * pi * (high - low)) : 0.0; }};
}
/// von Mises & Fisher.
Lobe fisher(Vec3d axis, double k) {
    const double tail = math::exp(-2 * k);
    return {axis, [k, tail](double u) { return 1 + math::log(u + (1 - u) * tail) / k; },
        [k, tail](double c) { return k / (2 * pi * (1 - tail)) * math::exp(k * (c - 1)); }};
}
/// Henyey & Greenstein 1941.
Lobe greenstein(Vec3d axis, double g) {
    return {axis, [g](double u) { return (1 + g * g - sqr((1 - g * g) / (1 - g + 2 * g * u))) / (2 * g); },
        [g](double c) { return (1 - g * g) / (4 * pi * math::pow(std::max(1 + g * g - 2 * g * c, 1e-300), 1.5)); }};
}

SyntheticSampler cosine_power(Rng& d) {
    const double s = d.log(0.1, 1e4);
    const Vec3d axis = d.direction(-1, 1);
    return of_lobe("cosine power", fmt::format("s {:.4g}, axis z {:.3f}", s, axis.z), power(axis, s));
}
SyntheticSampler clipped_power(Rng& d) {
    const double s = d.log(0.5, 300);
    const Vec3d axis = d.direction(-0.2, 1);
    return of_lobe("clipped power", fmt::format("s {:.4g}, axis z {:.3f}", s, axis.z), power(axis, s), true);
}
SyntheticSampler cone(Rng& d) {
    const double gap = d.log(1e-5, 1.5);
    const Vec3d axis = d.direction(-1, 1);
    return of_lobe("uniform cone", fmt::format("1 - cos {:.4g}, axis z {:.3f}", gap, axis.z), band(axis, 1 - gap, 1));
}
SyntheticSampler clipped_cone(Rng& d) {
    const double gap = d.log(1e-2, 1.5);
    const Vec3d axis = d.direction(-0.05, 0.5);
    return of_lobe(
        "clipped cone", fmt::format("1 - cos {:.4g}, axis z {:.3f}", gap, axis.z), band(axis, 1 - gap, 1), true);
}
SyntheticSampler ring(Rng& d) {
    const double high = d.uniform(-0.5, 0.98), low = high - d.log(3e-3, 0.4);
    const Vec3d axis = d.direction(-1, 1);
    return of_lobe(
        "ring", fmt::format("cos {:.4f} to {:.4f}, axis z {:.3f}", low, high, axis.z), band(axis, low, high));
}
SyntheticSampler phase(Rng& d) {
    const double g = d.uniform(-0.95, 0.95);
    const Vec3d axis = d.direction(-1, 1);
    return of_lobe("Henyey-Greenstein", fmt::format("g {:.3f}, axis z {:.3f}", g, axis.z), greenstein(axis, g));
}

/// A rectangular light from a point, by area: p = r^2 / (A cos), 0 outside.
SyntheticSampler rectangle(Rng& d) {
    const Vec3d normal = d.direction(-1, 1), centre = d.direction(-0.3, 1) * d.log(0.3, 3);
    const Frame<double> f = frame_about(normal);
    const double a = d.log(0.05, 2), b = d.log(0.05, 2), area = 4 * a * b;
    SyntheticSampler r{"rectangle light",
        fmt::format("{:.3f} x {:.3f} at {:.3f}", 2 * a, 2 * b, std::sqrt(dot(centre, centre))), {}, {}, {}};
    const auto at = [normal, area](
                        Vec3d wi, double r2) { return r2 / (area * std::max(std::fabs(dot(wi, normal)), 1e-12)); };
    r.pdf = [f, a, b, centre, normal, at](Vec3d, Vec3d wi) {
        const double t = dot(centre, normal) / dot(wi, normal);
        if (!(t > 0) || !std::isfinite(t)) return 0.0;
        const Vec3d off = wi * t - centre;
        const double x = std::fabs(dot(off, f.t)), y = std::fabs(dot(off, f.b));
        return x <= a * (1 + 1e-12) && y <= b * (1 + 1e-12) ? at(wi, t * t) : 0.0;
    };
    r.sample = [f, a, b, centre, at](Vec3d, Vec2d u) {
        const Vec3d y = centre + f.t * (a * (2 * u.x - 1)) + f.b * (b * (2 * u.y - 1));
        const double r2 = dot(y, y);
        const Vec3d wi = y * (1 / std::sqrt(r2));
        return Draw{wi, at(wi, r2), {}, {}};
    };
    return r;
}

/// Lobes selected by u.x, which is stretched for reuse.
SyntheticSampler mixture_of(std::string family, std::string parameters, std::vector<std::pair<double, Lobe>> parts) {
    double sum = 0;
    for (const auto& part : parts) sum += part.first;
    for (auto& part : parts) part.first /= sum;
    SyntheticSampler r{std::move(family), std::move(parameters), {}, {}, {}};
    const auto pdf = [parts](Vec3d, Vec3d wi) {
        double p = 0;
        for (const auto& [share, lobe] : parts) p += share * lobe.density(dot(wi, lobe.axis));
        return p;
    };
    r.pdf = pdf;
    r.sample = [parts, pdf](Vec3d wo, Vec2d u) {
        std::size_t k = 0;
        for (; k + 1 < parts.size() && u.x >= parts[k].first; ++k) u.x -= parts[k].first;
        u.x = std::clamp(u.x / parts[k].first, 0x1p-60, 1 - 0x1p-53);
        const Vec3d wi = about(parts[k].second.axis, parts[k].second.cos(u.x), u.y);
        return Draw{wi, pdf(wo, wi), {}, {}};
    };
    return r;
}

SyntheticSampler fishers(Rng& d) {
    std::vector<std::pair<double, Lobe>> parts;
    std::string describe;
    for (int i = 0, n = d.whole(1, 4); i < n; ++i) {
        const double k = d.log(1, 1e4), share = d.uniform(0.1, 1);
        parts.emplace_back(share, fisher(d.direction(-1, 1), k));
        describe += fmt::format("{}kappa {:.4g}", i ? ", " : "", k);
    }
    return mixture_of("von Mises-Fisher", describe, std::move(parts));
}
SyntheticSampler cones(Rng& d) {
    std::vector<std::pair<double, Lobe>> parts = {{0.3, band({0, 0, 1}, 0, 1)}};
    for (int i = 0, n = d.whole(1, 4); i < n; ++i)
        parts.emplace_back(d.uniform(0.1, 1), band(d.direction(0, 1), 1 - d.log(1e-3, 0.5), 1));
    return mixture_of("cones over a hemisphere", fmt::format("{} cones", parts.size() - 1), std::move(parts));
}

/// Lambert and Phong, drawn by both in proportion.
SyntheticSampler plastic(Rng& d) {
    const double s = d.log(1, 3000), rho_d = d.uniform(0.1, 0.5), rho_s = d.uniform(0.1, 0.5),
                 share = rho_d / (rho_d + rho_s);
    SyntheticSampler r{"plastic", fmt::format("s {:.4g}, {:.2f} + {:.2f}", s, rho_d, rho_s), {}, {}, {}};
    const auto pdf = [s, share](Vec3d wo, Vec3d wi) {
        return share * std::max(wi.z, 0.0) / pi +
            (1 - share) * power({-wo.x, -wo.y, wo.z}, s).density(dot(wi, Vec3d{-wo.x, -wo.y, wo.z}));
    };
    r.pdf = pdf;
    r.sample = [s, share, pdf](Vec3d wo, Vec2d u) {
        const bool flat = u.x < share;
        u.x = flat ? u.x / share : (u.x - share) / (1 - share);
        const Vec3d wi = flat ? about({0, 0, 1}, std::sqrt(std::max(1 - u.x, 0.0)), u.y)
                              : about({-wo.x, -wo.y, wo.z}, math::pow(u.x, 1 / (s + 1)), u.y);
        return Draw{wi, pdf(wo, wi), {}, {}};
    };
    r.f = [s, rho_d, rho_s](Vec3d wo, Vec3d wi) {
        if (!(wo.z > 0 && wi.z > 0)) return 0.0;
        return rho_d / pi +
            rho_s * (s + 2) / (2 * pi) * math::pow(std::clamp(dot(wi, Vec3d{-wo.x, -wo.y, wo.z}), 0.0, 1.0), s);
    };
    return r;
}

}  // namespace

std::vector<SamplerFamily> lobe_families() {
    return {cosine_power, clipped_power, cone, clipped_cone, ring, phase, rectangle, fishers, cones, plastic};
}

}  // namespace crescent
