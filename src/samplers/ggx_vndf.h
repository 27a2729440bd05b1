// ggx-vndf: a GGX normal among those visible from wo, mirrored to wi.
//   p = G1(wo) D(m) max(wo.m, 0) / wo.z / (4 wo.m) = G1(wo) D(m) / (4 wo.z).
// Heitz 2018, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), eq. (3) and (17); the draw by a spherical
// cap in the stretched space: Dupuy & Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", CGF 42(8),
// listing 3. With u1 the height on the cap and u2 the angle.
#pragma once

#include "samplers/halfway.h"
#include "scene/lobes/ggx.h"

namespace crescent {

template <class F> struct GgxVndf {
    static constexpr std::string_view name = "ggx-vndf";
    static constexpr CaseSurface check_cases[] = {{.lobe = "ggx", .sharpness = 0.5}, {.lobe = "ggx", .sharpness = 0.1},
        {.lobe = "ggx", .sharpness = 0.01}, {.lobe = "ggx", .sharpness = 0.001},
        {.lobe = "ggx", .sharpness = 0.3, .lambert = true}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "a half vector by the GGX distribution of the normals that w_o sees",
        .formula = R"(\frac{G_1(\omega_o)\,D(m)}{4(n\cdot\omega_o)})",
        .draw = "even over a spherical cap, stretched",
        .axis = "the normal $n$",
        .check_cases = check_cases,
        .gl = {5e-5, "D(m) in f and p nearly cancel: (n.m)^4 near the pole is off by 1e-7/alpha^2 in each"}};
    static ExpectedBehaviour theory(const CasePoint&) { return {.bounded = true}; }
    Ggx<F> ggx;
    explicit GgxVndf(const ShadingPoint<F>& shading_point) : ggx{shading_point.alpha} {}

    Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const F one = number<F>(1);
        const Vec3<F> stretched = stretched_by(ggx.alpha, wo);
        const F rise = (one - u.x) * (one + stretched.z);  // z + stretched.z on the cap
        const F z = rise - stretched.z;
        const F sin = sqrt(larger((one - z) * (one + z), number<F>(0)));
        const Vec3<F> m = normal_from_cap(ggx.alpha, stretched, sin, sincos_turns(u.y), rise);
        const Vec3<F> wi = mirror_about(wo, m);
        return {wi, density(wo, wi, m)};
    }
    PerSr<F> pdf(Vec3<F> wo, Vec3<F> wi) const { return density(wo, wi, halfway(wo, wi)); }

private:
    PerSr<F> density(Vec3<F> wo, Vec3<F> wi, Vec3<F> m) const {
        return above(wo, wi, ggx.G1(wo) * ggx.D(m) / (number<F>(4) * larger(wo.z, number<F>(1e-12))));
    }
};

}  // namespace crescent
