// light-triangle: next-event estimation towards the emitting triangles of meshes, a triangle by its power.
//   A triangle with the probability of Y(L_k) A_k, chosen by u1, then a point uniform over it: with u1 stretched,
//   y = c0 + sqrt(u1) (1 - u2) (c1 - c0) + sqrt(u1) u2 (c2 - c0). So p_A = Y(L_k) / sum of Y(L) A, and
//   p = p_A |y - x|^2 / cos(light), summed over all triangles that the direction meets. Fronts emit; a triangle whose
//   front does not face x gives nothing.
// It reaches only these triangles: under other light it is biased, unless another technique adds that. Shirley, Wang &
// Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting Calculations".
#pragma once

#include "math/simd/scalar.h"
#include "samplers/sampler.h"

namespace crescent {

template <class F> struct LightTriangle {
    static constexpr std::string_view name = "light-triangle";
    static constexpr CaseSurface check_cases[] = {{.lambert = true, .light = "triangles"},
        {.lobe = "phong", .sharpness = 8, .lambert = true, .light = "triangles"},
        {.lambert = true, .light = "fill + triangles"}};
    static constexpr SamplerDoc manual = {.label = name,
        .summary = "next-event estimation: a point of an emitting triangle, by power and even over its area",
        .formula = R"(\frac{L\lvert y-x\rvert^2}{\Phi\cos\theta_y})",
        .draw = R"(a triangle by its power $LA$, then even over its area; $\Phi$ is the sum of all powers)",
        .axis = "the triangle",
        .misses = light_arm_misses,
        .reaches = {.fill = false, .lights = false, .sky = false},
        .check_cases = check_cases};
    static ExpectedBehaviour theory(const CasePoint& point) { return theory_of_light_arm(point); }

    const Surroundings* surroundings;
    Vec3<F> position;
    Frame<F> frame;

    explicit LightTriangle(const ShadingPoint<F>& shading_point)
        : surroundings(shading_point.around), position(shading_point.position), frame(shading_point.frame) {}

    DrawnToTriangle<F> sample(Vec3<F> /*wo*/, Vec2<F> u) const { return drawn_by(u, true); }
    /// Without the densities of the other triangles that the direction meets.
    DrawnToTriangle<F> sample_part(Vec2<F> u) const { return drawn_by(u, false); }
    /// The density of the direction that u draws, in these lanes.
    [[gnu::noinline]] PerSr<F> whole_pdf(Vec2<F> u, MaskOf<F> where) const {
        using Scalar = typename LaneArray<F>::Scalar;
        const LaneArray<F> ux(u.x), uy(u.y), px(position.x), py(position.y), pz(position.z),
            flags(select(where, number<F>(1), number<F>(0)));
        LaneArray<F> p(number<F>(0));
        for (std::size_t l = 0; surroundings && l < Lanes<F>::count; ++l)
            if (flags.at[l] > 0)
                p.at[l] = static_cast<Scalar>(sample_triangles(*surroundings,
                    {double(px.at[l]), double(py.at[l]), double(pz.at[l])}, double(ux.at[l]), double(uy.at[l]), true)
                        .pdf);
        return {p.pack()};
    }

    PerSr<F> pdf(Vec3<F> /*wo*/, Vec3<F> wi) const {
        const F zero = number<F>(0);
        return pdf_of(wi, !(zero > zero));
    }
    /// The density of a drawn direction in these lanes.
    PerSr<F> pdf_where(const DrawnByAny<F>& draw, MaskOf<F> where) const { return pdf_of(draw.wi, where); }

private:
    [[gnu::noinline]] DrawnToTriangle<F> drawn_by(Vec2<F> u, bool is_whole) const {
        const F zero = number<F>(0);
        if (!surroundings) return {{{zero, zero, number<F>(1)}, {zero}}, UintOf<F>(no_triangle)};
        using Scalar = typename LaneArray<F>::Scalar;
        const LaneArray<F> ux(u.x), uy(u.y), px(position.x), py(position.y), pz(position.z);
        LaneArray<F> x, y, z, p;
        LaneIntegers<F> triangle;
        for (std::size_t l = 0; l < Lanes<F>::count; ++l) {
            const TriangleDraw draw = sample_triangles(*surroundings,
                {double(px.at[l]), double(py.at[l]), double(pz.at[l])}, double(ux.at[l]), double(uy.at[l]), is_whole);
            x.at[l] = static_cast<Scalar>(draw.w.x);
            y.at[l] = static_cast<Scalar>(draw.w.y);
            z.at[l] = static_cast<Scalar>(draw.w.z);
            p.at[l] = static_cast<Scalar>(draw.pdf);
            triangle.at[l] = draw.triangle;
        }
        return {{frame.to_local({x.pack(), y.pack(), z.pack()}), {p.pack()}}, triangle.pack()};
    }

    [[gnu::noinline]] PerSr<F> pdf_of(Vec3<F> wi, MaskOf<F> where) const {
        if (!surroundings) return {number<F>(0)};
        using Scalar = typename LaneArray<F>::Scalar;
        const Vec3<F> d = frame.to_world(wi);
        const LaneArray<F> x(d.x), y(d.y), z(d.z), px(position.x), py(position.y), pz(position.z),
            flags(select(where, number<F>(1), number<F>(0)));
        LaneArray<F> p(number<F>(0));
        for (std::size_t l = 0; l < Lanes<F>::count; ++l) {
            if (!(flags.at[l] > 0)) continue;
            p.at[l] =
                static_cast<Scalar>(triangles_pdf(*surroundings, {double(px.at[l]), double(py.at[l]), double(pz.at[l])},
                    {double(x.at[l]), double(y.at[l]), double(z.at[l])}));
        }
        return {p.pack()};
    }
};

}  // namespace crescent
