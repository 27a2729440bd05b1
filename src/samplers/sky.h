// sky: a direction of an image sky, by its luminance.
//   A texel with the probability of its mass Y(L) dw, where dw = 2 pi / width (cos theta_r - cos theta_(r+1)) is its
//   exact solid angle: u1 chooses a row, u2 a column of it, and what is left of both a direction, uniform in solid
//   angle within the texel. So p = Y(L) / sum of Y(L) dw over all texels, over the whole sphere: half of a bright
//   horizon is below the surface, where samples have weight 0.
// It reaches only the sky: under a fill it is biased by the fill, and by the lights, unless another technique adds
// them. Pharr, Jakob & Humphreys 2023, "Physically Based Rendering", 12.5, without its interpolation. A scene without a
// sky has no such direction: nothing is drawn.
#pragma once

#include <array>

#include "math/simd/scalar.h"
#include "samplers/sampler.h"

namespace crescent {

template <class F> struct SkyByTexel {
    static constexpr std::string_view name = "sky";
    static constexpr CaseSurface check_cases[] = {
        {.lambert = true, .light = "sky"}, {.lobe = "phong", .sharpness = 8, .lambert = true, .light = "sky"}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "a direction of the image sky, by the luminance of its texels",
        .formula = R"(\frac{L_\omega}{\Phi})",
        .draw =
            R"(a texel by its mass $L_\omega\Delta\omega$, then even over its solid angle; $\Phi$ is the sum of all)",
        .axis = "the sky",
        .misses = light_arm_misses,
        .reaches = {.fill = false, .lights = false, .triangles = false},
        .check_cases = check_cases};
    static ExpectedBehaviour theory(const CasePoint& point) { return theory_of_light_arm(point); }

    const Surroundings* surroundings;
    Frame<F> frame;

    explicit SkyByTexel(const ShadingPoint<F>& shading_point)
        : surroundings(shading_point.around), frame(shading_point.frame) {}

    [[gnu::noinline]] DrawnToSky<F> sample(Vec3<F> /*wo*/, Vec2<F> u) const {
        const F zero = number<F>(0);
        if (!surroundings) return {{{zero, zero, number<F>(1)}, {zero}}, UintOf<F>(no_texel)};
        using Scalar = typename LaneArray<F>::Scalar;
        constexpr std::size_t lanes = Lanes<F>::count;
        const LaneArray<F> ux(u.x), uy(u.y);
        std::array<double, lanes> u1, u2;
        for (std::size_t l = 0; l < lanes; ++l) {
            u1[l] = double(ux.at[l]);
            u2[l] = double(uy.at[l]);
        }
        std::array<SkyDraw, lanes> draws;
        sample_sky(*surroundings, u1, u2, draws);
        LaneArray<F> x, y, z, p;
        LaneIntegers<F> texel;
        for (std::size_t l = 0; l < lanes; ++l) {
            x.at[l] = static_cast<Scalar>(draws[l].w.x);
            y.at[l] = static_cast<Scalar>(draws[l].w.y);
            z.at[l] = static_cast<Scalar>(draws[l].w.z);
            p.at[l] = static_cast<Scalar>(draws[l].pdf);
            texel.at[l] = draws[l].texel;
        }
        return {{frame.to_local({x.pack(), y.pack(), z.pack()}), {p.pack()}}, texel.pack()};
    }

    PerSr<F> pdf(Vec3<F> /*wo*/, Vec3<F> wi) const {
        const F zero = number<F>(0);
        return pdf_of(wi, LaneIntegers<F>(UintOf<F>(no_texel)), !(zero > zero));
    }
    /// The density of a drawn direction, whose texel may be known, in these lanes.
    PerSr<F> pdf_where(const DrawnByAny<F>& draw, MaskOf<F> where) const {
        return pdf_of(draw.wi, LaneIntegers<F>(draw.texel), where);
    }

private:
    [[gnu::noinline]] PerSr<F> pdf_of(Vec3<F> wi, const LaneIntegers<F>& texel, MaskOf<F> where) const {
        if (!surroundings) return {number<F>(0)};
        using Scalar = typename LaneArray<F>::Scalar;
        const Vec3<F> d = frame.to_world(wi);
        const LaneArray<F> x(d.x), y(d.y), z(d.z), flags(select(where, number<F>(1), number<F>(0)));
        LaneArray<F> p(number<F>(0));
        for (std::size_t l = 0; l < Lanes<F>::count; ++l)
            if (flags.at[l] > 0)
                p.at[l] = static_cast<Scalar>(
                    sky_pdf(*surroundings, texel.at[l], {double(x.at[l]), double(y.at[l]), double(z.at[l])}));
        return {p.pack()};
    }
};

}  // namespace crescent
