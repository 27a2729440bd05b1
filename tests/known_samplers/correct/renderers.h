// Samplers in the forms used by renderers, in double and from their sources: rough glass, a smooth coat, layers in
// colour, skies.
#pragma once

#include "tests/known_samplers/correct/right.h"

namespace crescent {

/// Rough dielectric boundary, GGX with separable G: Walter et al. 2007, "Microfacet Models for Refraction through Rough
/// Surfaces"; visible normals after Heitz 2018. Three random numbers: the third selects reflection by Fresnel, or by
/// `reflect`.
struct RoughGlass {
    double alpha = 0.3, eta = 1.5;  // eta: index below over above
    bool visible = true, importance = false;
    std::function<double(double fresnel)> reflect{};  // the probability that the draw uses; Fresnel if empty

    double eta_from(Vec3d o) const { return o.z > 0 ? eta : 1 / eta; }
    bool across(Vec3d o, Vec3d i) const { return o.z * i.z < 0; }
    /// The half vector on the upper side, (13) and (16).
    Vec3d half(Vec3d o, Vec3d i) const;
    double D(Vec3d m) const;                           // (33)
    double G1(Vec3d w, Vec3d m) const;                 // (34)
    double fresnel(double c, double eta_here) const;   // (22)
    double jacobian(Vec3d o, Vec3d i, Vec3d m) const;  // (14), (17)
    double pdf(Vec3d o, Vec3d i) const;
    double f(Vec3d o, Vec3d i) const;  // (20), (21)
    Draw sample(Vec3d o, const PrimarySample& u) const;
    Traits traits() const;

private:
    double normals_pdf(Vec3d o, Vec3d m) const;
    Vec3d normal(Vec3d o, double u1, double u2) const;
};
SyntheticSampler recipe_of(const RoughGlass& glass);

/// A coat that mirrors `mirrored` of the light, a delta part selected by the third number with probability q, over
/// Lambert in three channels.
struct SmoothCoat {
    double mirrored = 0.2, q = 0.3;
    Vec3d base{0.7, 0.4, 0.1};
    double pdf(Vec3d wi) const { return wi.z > 0 ? (1 - q) * wi.z / pi_ : 0; }
    Vec3d f(Vec3d wi) const { return wi.z > 0 ? base * ((1 - mirrored) / pi_) : Vec3d{}; }
    Draw sample(Vec3d wo, const PrimarySample& u) const;
    static constexpr double pi_ = 3.14159265358979323846;
};
SyntheticSampler recipe_of(const SmoothCoat& coat);

/// A smooth boundary between two media: only delta parts, reflection and refraction by Fresnel.
SyntheticSampler smooth_glass(double eta);

/// A GGX lobe with Schlick's Fresnel in three channels over Lambert, the lobe selected by the third number.
struct Layers {
    double alpha = 0.3, choice = 0.5;
    Vec3d base{0.5, 0.3, 0.1}, normal_reflectance{0.04, 0.05, 0.06};
    double lobe_pdf(Vec3d wo, Vec3d wi) const;
    double pdf(Vec3d wo, Vec3d wi) const;
    Vec3d f(Vec3d wo, Vec3d wi) const;
    Draw sample(Vec3d wo, const PrimarySample& u) const;
};
SyntheticSampler recipe_of(const Layers& layers);

/// A sky of rows x columns texels in theta x phi, p proportional to the texel's radiance times its sine: p = n m mass /
/// (2 pi^2 sin theta).
struct Sky {
    int rows, columns;
    std::vector<double> mass;  // by texel; sums to 1
    bool by_alias = false;
    std::vector<double> row_sums, sums;  // by CDF
    std::vector<double> keep;            // by alias table, Vose 1991
    std::vector<int> other;

    Sky(int rows, int columns, std::vector<double> radiance, bool by_alias);
    double pdf(Vec3d wi) const;
    Draw sample(const PrimarySample& u) const;
    /// Texel and place within it.
    struct Spot {
        int i, j;
        double x, y;
    };
    Spot spot(Vec2d u) const;
    Draw at(const Spot& s) const;
};
SyntheticSampler recipe_of(std::shared_ptr<const Sky> sky);
/// Texels of noise, and a sun of a few texels that has `sun` of the light.
std::shared_ptr<const Sky> sky_with_sun(Rng& d, int rows, int columns, double sun, bool by_alias);

/// A sky whose p is bilinear between cells x cells points, in single precision, with a sun `sun` times as bright.
SyntheticSampler smooth_sky(int cells, double sun);

std::vector<SamplerFamily> renderer_families();

}  // namespace crescent
