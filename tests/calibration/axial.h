// Lobes that are symmetric about an axis, given by the distribution of t = 1 - cos(theta), and mixtures of them.
#pragma once

#include "tests/calibration/geometry.h"
#include "tests/calibration/sampler.h"

namespace crescent::calibration {

/// t as a function of a uniform number, and the density per solid angle as a function of t.
template <class F> struct Profile {
    std::function<F(F u)> t;
    std::function<F(F t)> density;
};

/// Cosine power: (s + 1) / (2 pi) cos^s.
template <class F> Profile<F> power_profile(F s) {
    return {[s](F u) { return -std::expm1(std::log(std::max(u, F(1e-30))) / (s + 1)); },
        [s](F t) { return t < 1 ? (s + 1) / (2 * pi_of<F>)*std::exp(s * std::log1p(-t)) : F(0); }};
}
/// Uniform in a cone; the rim is widened by the rounding of directions.
template <class F> Profile<F> cone_profile(F gap) {
    const F rim = gap + std::sqrt(2 * gap) * slack<F> + slack<F> * slack<F>, density = 1 / (2 * pi_of<F> * gap);
    return {[gap](F u) { return gap * u; }, [rim, density](F t) { return t <= rim ? density : F(0); }};
}
/// von Mises and Fisher, k / (2 pi (1 - e^-2k)) e^-kt: Jakob 2012, "Numerically Stable Sampling of the von Mises-Fisher
/// Distribution on S2".
template <class F> Profile<F> fisher_profile(F k) {
    const F tail = -std::expm1(-2 * k), c = k / (2 * pi_of<F> * tail);
    return {[k, tail](F u) { return -std::log1p(-u * tail) / k; }, [k, c](F t) { return c * std::exp(-k * t); }};
}
/// Henyey and Greenstein 1941, g in (-1, 1) but not 0.
template <class F> Profile<F> greenstein_profile(F g) {
    return {[g](F u) {  // (s - (1 - g)) (s + 1 - g) / (2 g), with s - (1 - g) written out
                const F s = (1 - g * g) / (1 - g + 2 * g * u), less = (1 - g) * 2 * g * (1 - u) / (1 - g + 2 * g * u);
                return std::clamp(less * (s + (1 - g)) / (2 * g), F(0), F(2));
            },
        [g](F t) {
            return (1 - g * g) / (4 * pi_of<F> * std::pow(std::max(sqr(1 - g) + 2 * g * t, F(1e-30)), F(1.5)));
        }};
}

/// One lobe with its weight in a mixture, about an axis that may depend on w_o.
template <class F> struct Lobe {
    F weight;
    std::function<Vec3<F>(Vec3<F> wo)> axis;
    Profile<F> profile;
};
template <class F> std::function<Vec3<F>(Vec3<F>)> fixed(Vec3d axis) {
    return [a = cast<F>(axis)](Vec3<F>) { return a; };
}
template <class F> std::function<Vec3<F>(Vec3<F>)> mirror_direction() {
    return [](Vec3<F> wo) { return Vec3<F>{-wo.x, -wo.y, wo.z}; };
}
/// The direction of light that is not scattered, -w_o.
template <class F> std::function<Vec3<F>(Vec3<F>)> forward() {
    return [](Vec3<F> wo) { return -wo; };
}

template <class F> Functions<F> single(std::function<Vec3<F>(Vec3<F>)> axis, Profile<F> profile) {
    Functions<F> out;
    out.pdf = [axis, profile](Vec3<F> wo, Vec3<F> wi) { return profile.density(versine(axis(wo), wi)); };
    out.sample = [axis, profile, pdf = out.pdf](Vec3<F> wo, const F* u) {
        const Vec3<F> wi = off_axis(axis(wo), profile.t(u[0]), u[1]);
        return Drawn<F>{wi, pdf(wo, wi)};
    };
    return out;
}

/// u[2] selects the lobe. Weights are normalised here.
template <class F> Functions<F> mixture(std::vector<Lobe<F>> lobes, Broken broken) {
    F sum = 0;
    for (const Lobe<F>& l : lobes) sum += l.weight;
    for (Lobe<F>& l : lobes) l.weight /= sum;
    Functions<F> out;
    out.pdf = [lobes, broken](Vec3<F> wo, Vec3<F> wi) {
        F total = 0, largest = 0;
        for (const Lobe<F>& l : lobes) {
            const F p = l.profile.density(versine(l.axis(wo), wi));
            largest = std::max(largest, p);
            total += (broken == Broken::equal_weights       ? F(1) / F(lobes.size())
                             : broken == Broken::no_weights ? F(1)
                                                            : l.weight) *
                p;
        }
        return broken == Broken::lobe_pdf ? largest : total;
    };
    out.sample = [lobes, pdf = out.pdf](Vec3<F> wo, const F* u) {
        std::size_t k = 0;
        for (F rest = u[2]; k + 1 < lobes.size() && rest >= lobes[k].weight; ++k) rest -= lobes[k].weight;
        const Vec3<F> wi = off_axis(lobes[k].axis(wo), lobes[k].profile.t(u[0]), u[1]);
        return Drawn<F>{wi, pdf(wo, wi)};
    };
    return out;
}

}  // namespace crescent::calibration
