// Lo = (1/N) sum f L_i cos / p, written plainly: a loop over pixels, a loop over samples, double precision, a generator
// from the standard library, std::pow, std::cos, and scene queries one ray at a time. Same scene, same samplers, same
// N.
#include "straightforward.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>
#include <vector>

namespace crescent::bench {

namespace {

constexpr double pi = 3.14159265358979323846;

struct Basis {
    Vec3d t, b, n;
};

Basis basis_about(Vec3d n) {
    const Vec3d other = std::fabs(n.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    Vec3d t = cross(other, n);
    t = t * (1 / std::sqrt(dot(t, t)));
    return {t, cross(n, t), n};
}

Vec3d about(const Basis& basis, double cos, double phi) {
    const double sin = std::sqrt(std::max(0.0, 1 - cos * cos));
    return basis.t * (sin * std::cos(phi)) + basis.b * (sin * std::sin(phi)) + basis.n * cos;
}

struct Point {
    Hit hit;
    Surface surface;
    Vec3d mirror;
    Basis normal_basis, mirror_basis;
};

Vec3d draw(const std::string& sampler, const Point& at, double u1, double u2, double& pdf) {
    const double phi = 2 * pi * u2, s = at.surface.s;
    if (sampler == "uniform") {
        pdf = 1 / (2 * pi);
        return about(at.normal_basis, u1, phi);
    }
    if (sampler == "cosine") {
        const double cos = std::sqrt(u1);
        pdf = cos / pi;
        return about(at.normal_basis, cos, phi);
    }
    const double cos = std::pow(u1, 1 / (s + 1));
    pdf = (s + 1) / (2 * pi) * std::pow(cos, s);
    return about(at.mirror_basis, cos, phi);
}

/// Returns whether the segment from x to y crosses the body, by a very short chord at y.
bool blocks(const Occluder& body, Vec3d x, Vec3d y) {
    const auto parts = hidden(body, x, y, y + 1e-9 * frame_about(normalize(y - x)).t);
    return !parts[0].empty() || !parts[1].empty();
}

Rgb incident(const Scene& scene, const Point& at, Vec3d wi) {
    double nearest = 1e30;
    Rgb radiance = scene.fill();
    for (const Light& light : scene.lights()) {
        const lights::Disk& disk = std::get<lights::Disk>(light.form);
        const double v = dot(wi, disk.normal);
        if (v >= 0 && !disk.two_sided) continue;
        const double t = dot(disk.center - at.hit.x, disk.normal) / v;
        const Vec3d y = at.hit.x + wi * t, off = y - disk.center;
        if (!(t > 0) || t >= nearest || dot(off, off) > disk.radius * disk.radius) continue;
        const auto hides = [&](const Occluder& o) { return o.shape != at.hit.shape && blocks(o, at.hit.x, y); };
        nearest = t;
        const bool hidden = std::any_of(scene.occluders().begin(), scene.occluders().end(), hides);
        radiance = hidden ? scene.fill() : light.radiance;
    }
    return radiance;
}

Rgb pixel(const Scene& scene, const std::string& sampler, const Point& at, int n, std::mt19937& generator) {
    std::uniform_real_distribution<double> uniform;
    Rgb sum{};
    for (int k = 0; k < n; ++k) {
        const double u1 = uniform(generator), u2 = uniform(generator);
        double pdf = 0;
        const Vec3d wi = draw(sampler, at, u1, u2, pdf);
        const double cos = dot(wi, at.hit.n);
        if (cos <= 0 || pdf <= 0) continue;
        const double s = at.surface.s;
        const double lobe = at.surface.rho_s * (s + 2) / (2 * pi) * std::pow(std::max(0.0, dot(wi, at.mirror)), s);
        const Rgb radiance = incident(scene, at, wi);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += (at.surface.rho_d[c] / pi + lobe) * radiance[c] * cos / pdf;
    }
    for (double& c : sum) c /= n;
    return sum;
}

double row(const Scene& scene, const std::string& sampler, int j, int n, std::uint32_t seed) {
    double sum = 0;
    std::mt19937 generator(seed + static_cast<std::uint32_t>(j));
    for (int i = 0; i < scene.image().width; ++i) {
        const auto hit = scene.primary(i, j);
        if (!hit) continue;
        Point at{*hit, scene.surface(*hit), {}, {}, {}};
        at.mirror = hit->n * (2 * dot(hit->wo, hit->n)) - hit->wo;
        at.normal_basis = basis_about(hit->n);
        at.mirror_basis = basis_about(at.mirror);
        sum += luminance(pixel(scene, sampler, at, n, generator));
    }
    return sum;
}

}  // namespace

double straightforward(const Scene& scene, const std::string& sampler, int n, std::uint32_t seed, int threads) {
    const Image image = scene.image();
    std::vector<double> rows(static_cast<std::size_t>(image.height));
    std::vector<std::thread> crew;
    for (int t = 0; t < threads; ++t)
        crew.emplace_back([&, t] {
            for (int j = t; j < image.height; j += threads)
                rows[static_cast<std::size_t>(j)] = row(scene, sampler, j, n, seed);
        });
    for (std::thread& worker : crew) worker.join();
    double sum = 0;
    for (double y : rows) sum += y;
    return sum / (static_cast<double>(image.width) * image.height);
}

}  // namespace crescent::bench
