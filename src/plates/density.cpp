// The arm is made in double at a point with the material of the shape whose exponent is the experiment's, and one from
// outside is asked there; its peak is the largest of 1801 angles. An arm that aims at lights is asked at the pixel, of
// a few thousand, with R nearest to the tilt and a light nearest to R's plane; its peak is that of 1024 draws.
#include "plates/density.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "arms/all.h"
#include "color/rgb.h"
#include "estimator/pixel.h"
#include "math/functions.h"
#include "scene/scene.h"

namespace crescent::plates {

namespace {

// The surface that the density is shown for: that of the shape whose exponent is the experiment's.
ShadingPoint<double> site_of(const Experiment& e, double s, double tilt) {
    const Shape* shape = e.shape_of_s();
    Material material = shape ? shape->material : Material{};
    material.s = s;
    const Surface surface = surface_of(material, s);
    ShadingPoint<double> site{};
    site.wo = {-math::sin(tilt), 0, math::cos(tilt)};
    site.s = surface.s;
    site.alpha = surface.alpha;
    site.diffuse = luminance(surface.rho_d);
    site.lobe = surface.rho_s;
    return site;
}

// An arm without one density (several techniques, each with its own) is left at 0.
template <class Arm> constexpr bool has_pdf = requires(const Arm a, Vec3d w) { a.pdf(w, w); };

/// `angle` radians from n, in the plane of incidence.
Vec3d in_incidence(double angle) { return {math::sin(angle), 0, math::cos(angle)}; }

/// How far a pixel's picture is from one with R at `tilt` and a light in the plane of incidence, in radians; infinite
/// where no light shines on it or R is n.
double off_the_plane(const OpenPixel& pixel, double tilt) {
    const Vec3d r = pixel.mirror();
    const double out = math::hypot(r.x, r.y);
    double least = std::numeric_limits<double>::infinity();
    if (!(out > 0.01)) return least;
    for (const PixelLight& light : pixel.lights())
        if (light.faces && light.towards.z > 0.05)
            least = std::min(least,
                std::fabs(math::atan2(out, r.z) - tilt) +
                    std::fabs(math::asin((r.x * light.towards.y - r.y * light.towards.x) / out)));
    return least;
}

/// Of a few thousand pixels that see the shape whose exponent is the experiment's, or any where none has one.
std::shared_ptr<const OpenPixel> lit_pixel(const Experiment& e, double s, double tilt) {
    const Scene scene = Scene(e).with_s(s);
    const Shape* shape = e.shape_of_s();
    const std::ptrdiff_t wanted = shape ? shape - e.shapes.data() : -1;
    const int step =
        std::max(1, static_cast<int>(std::sqrt(e.image.width * static_cast<double>(e.image.height) / 4e3)));
    std::shared_ptr<const OpenPixel> best;
    double least = std::numeric_limits<double>::infinity();
    for (int j = 0; j < e.image.height; j += step)
        for (int i = 0; i < e.image.width; i += step) {
            const auto hit = scene.primary(i, j);
            if (!hit || (wanted >= 0 && hit->shape != wanted)) continue;
            auto pixel = std::make_shared<const OpenPixel>(scene, i, j);
            const double off = off_the_plane(*pixel, tilt);
            if (off < least) least = off, best = std::move(pixel);
        }
    return best;
}

/// A density that is asked for one direction after the other.
auto one_by_one(std::function<double(const Vec3d&)> pdf) {
    return [pdf = std::move(pdf)](std::span<const Vec3d> wi, std::span<double> out) {
        for (std::size_t i = 0; i < wi.size(); ++i) out[i] = pdf(wi[i]);
    };
}

bool aims_at_lights_alone(const std::string& sampler) {
    const ArmInfo* info = find_arm_info(sampler);
    return info && !info->combines && !info->misses.empty();
}

}  // namespace

Density::Density(const Experiment& e, const std::string& sampler, double s, double tilt)
    : ask_(one_by_one([](const Vec3d&) { return 0.0; })), tilt_(tilt) {
    if (aims_at_lights_alone(sampler)) {
        ask_at_a_pixel(e, sampler, s);
        return;
    }
    ShadingPoint<double> site = site_of(e, s, tilt);
    for_each_arm(Arms{}, [&]<template <class> class A>() {
        if constexpr (has_pdf<A<double>>) {
            if (sampler != A<double>::name) return;
            ask_ = one_by_one([arm = A<double>(site), wo = site.wo](const Vec3d& wi) {
                double p = arm.pdf(wo, wi).v;
                return std::isfinite(p) ? p : 0.0;
            });
        }
    });
    find_peak();
}

Density::Density(const Experiment& e, const OutsideSampler& outside, double s, double tilt) : tilt_(tilt) {
    const ShadingPoint<double> site = site_of(e, s, tilt);
    ask_ = [&outside, wo = site.wo, on = OutsideSurface{site.s, site.alpha, site.diffuse, site.lobe}](
               std::span<const Vec3d> wi, std::span<double> out) {
        outside.density(wo, on, wi, out);
        for (double& p : out) p = p > 0 && std::isfinite(p) ? p : 0.0;
    };
    if (!outside.has_density()) ask_ = one_by_one([](const Vec3d&) { return 0.0; });
    find_peak();
}

void Density::find_peak() {
    std::vector<Vec3d> plane;
    for (int i = -900; i <= 900; ++i) plane.push_back(in_incidence(i * pi / 1800));
    for (const double p : at(plane)) peak_ = std::max(peak_, p);
}

void Density::ask_at_a_pixel(const Experiment& e, const std::string& sampler, double s) {
    const std::shared_ptr<const OpenPixel> pixel = lit_pixel(e, s, tilt_);
    if (!pixel) return;
    const Vec3d r = pixel->mirror();
    const double out = math::hypot(r.x, r.y), x = r.x / out, y = r.y / out;  // towards R from n
    tilt_ = math::atan2(out, r.z);
    where_ = fmt::format("pixel ({}, {})", pixel->i(), pixel->j());
    ask_ = one_by_one([=](const Vec3d& wi) {
        const double p = pixel->pdf(sampler, {wi.x * x - wi.y * y, wi.x * y + wi.y * x, wi.z});
        return wi.z > 0 && std::isfinite(p) ? p : 0.0;
    });
    for (const PixelSample& drawn : pixel->samples(sampler, 1024, 1))
        if (drawn.cos > 0) peak_ = std::max(peak_, static_cast<double>(drawn.pdf));
}

std::vector<double> Density::at(std::span<const Vec3d> wi) const {
    std::vector<double> out(wi.size());
    ask_(wi, out);
    return out;
}

double Density::in_plane(double angle) const { return at(in_incidence(angle)); }

}  // namespace crescent::plates
