// Factors of a surface under a smooth boundary, of half vectors across one, and of two ways to write shadowing: each a
// whole factor, that explains the ratios with the constant 1 alone. m is the half vector. Where no index is told, those
// that renderers have by default are tried: dielectrics of common indices, and Schlick's approximation from common
// reflectances.
#include <algorithm>
#include <cmath>

#include "diagnosis/diagnosis.h"
#include "lobes/all.h"
#include "math/functions.h"

namespace crescent::inline diagnosis {

namespace {

/// Reflectance by the cosine, of a dielectric of that index (Walter et al. 2007, (22)), or Schlick's (1994) from r0.
struct Interface {
    double eta = 0, r0 = 0;
    double operator()(double c) const {
        c = std::fabs(c);
        if (eta == 0) return r0 + (1 - r0) * math::pow(std::max(1 - c, 0.0), 5);
        const double g2 = eta * eta - 1 + c * c;
        if (g2 <= 0) return 1;
        const double g = std::sqrt(g2), one = (g - c) / (g + c), two = (c * (g + c) - 1) / (c * (g - c) + 1);
        return 0.5 * one * one * (1 + two * two);
    }
};

std::vector<Interface> interfaces_of(const TrialContext& work) {
    if (work.traits.eta) {
        const double eta = work.traits.eta->x;
        return {{work.trial.wo.z > 0 ? eta : 1 / eta, 0}, {0, sqr((eta - 1) / (eta + 1))}};
    }
    std::vector<Interface> out;
    for (double eta : {1.5, 1.33, 1.4, 1.45, 1.6, 1.8}) out.push_back({eta, 0});
    for (double r0 : {0.04, 0.02, 0.05, 0.08, 0.5, 0.7, 0.8, 0.9, 0.95}) out.push_back({0, r0});
    return out;
}

void add_whole(std::vector<Factor>& out, const std::string& name, std::function<double(Vec3d)> g) {
    out.push_back({name, g, true});
    out.push_back({"1 / (" + name + ")",
        [g](Vec3d w) {
            const double v = g(w);
            return v > 0 ? 1 / v : 0;
        },
        true});
}

void add_interface(std::vector<Factor>& out, Vec3d wo, Interface f) {
    const double at_o = f(wo.z);
    const auto at_m = [wo, f](Vec3d w) {
        const Vec3d sum = wo + w;
        const double size = length(sum);
        return f(size > 1e-9 ? dot(wo, sum) / size : 1.0);
    };
    add_whole(out, "Fresnel", at_m);
    add_whole(out, "Fresnel at n over Fresnel at m", [=](Vec3d w) { return at_o / at_m(w); });
    add_whole(out, "Fresnel at n and w_i over Fresnel at m", [=](Vec3d w) { return f(w.z) / at_m(w); });
    add_whole(out, "the chooser's Fresnel at w_i over that at w_o", [=](Vec3d w) { return f(w.z) / at_o; });
    add_whole(
        out, "the chooser's 1 - Fresnel at w_i over that at w_o", [=](Vec3d w) { return (1 - f(w.z)) / (1 - at_o); });
    add_whole(out, "both passes through a coat, (1 - Fresnel at w_o) (1 - Fresnel at w_i)",
        [=](Vec3d w) { return (1 - f(w.z)) * (1 - at_o); });
    add_whole(out, "the pass of w_i through a coat, 1 - Fresnel at w_i", [=](Vec3d w) { return 1 - f(w.z); });
}

/// n.m of what is reflected and of what goes through a boundary of that index. Where the index is told, the usual
/// factors have it.
void add_half_vectors(std::vector<Factor>& out, Vec3d wo, double eta) {
    add_whole(out, "n.m", [=](Vec3d w) { return std::fabs(half_vector(wo, w, eta).z); });
}

/// Walter et al. 2007, (34): G1 = 2 / (1 + root), hence Lambda = 1 / G1 - 1; Heitz 2014, (99): G2 = 1 / (1 + sum).
void add_shadowing(std::vector<Factor>& out, Vec3d wo, double alpha) {
    const Ggx<double> ggx{alpha};
    const double at_o = 1 / ggx.G1(wo) - 1;
    add_whole(out, "G2 over G1 G1", [=](Vec3d w) {
        if (w.z * wo.z <= 0) return 0.0;
        const double at_i = 1 / ggx.G1(w) - 1;
        return (1 + at_o) * (1 + at_i) / (1 + at_o + at_i);
    });
}

}  // namespace

void add_whole_factors(std::vector<Factor>& out, const TrialContext& work) {
    for (const Interface& f : interfaces_of(work)) {
        add_interface(out, work.trial.wo, f);
        if (!work.whole() || work.traits.eta || f.eta == 0) continue;
        for (double eta : {f.eta, 1 / f.eta}) add_half_vectors(out, work.trial.wo, eta);
    }
    std::vector<double> alphas;  // round ones, and squares of round roughnesses
    for (int k = 1; k <= 20; ++k) alphas.push_back(0.05 * k), alphas.push_back(sqr(0.05 * k));
    for (const auto& [name, value] : work.trial.parameters)
        if (name == "alpha") alphas = {value};
    for (double alpha : alphas) add_shadowing(out, work.trial.wo, alpha);
}

}  // namespace crescent::inline diagnosis
