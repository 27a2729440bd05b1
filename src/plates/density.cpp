#include "plates/density.h"

#include <cmath>

#include "arms/all.h"
#include "color/rgb.h"
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

}  // namespace

Density::Density(const Experiment& e, const std::string& sampler, double s, double tilt)
    : pdf_([](const Vec3d&) { return 0.0; }) {
    ShadingPoint<double> site = site_of(e, s, tilt);
    for_each_arm(Arms{}, [&]<template <class> class A>() {
        if constexpr (has_pdf<A<double>>) {
            if (sampler != A<double>::name) return;
            pdf_ = [arm = A<double>(site), wo = site.wo](const Vec3d& wi) {
                double p = arm.pdf(wo, wi).v;
                return std::isfinite(p) ? p : 0.0;
            };
        }
    });
}

double Density::in_plane(double angle) const { return pdf_({math::sin(angle), 0, math::cos(angle)}); }

}  // namespace crescent::plates
