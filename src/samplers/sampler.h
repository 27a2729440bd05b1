// The interface of a sampler. Directions in the local frame (n = +z, wo given, wi drawn); u in [0,1)^2; pdf in 1/sr.
#pragma once

#include <array>
#include <concepts>
#include <string_view>

#include "base/vec.h"
#include "math/simd/frame.h"
#include "samplers/info.h"
#include "scene/lights/all.h"
#include "scene/lobes/lobe.h"
#include "scene/surroundings.h"

namespace crescent {

/// A density over solid angle, 1/sr.
template <class F> struct PerSr {
    F v;
};
/// A density over area, 1/m^2.
template <class F> struct PerM2 {
    F v;
};
/// dw = cos dA / r^2, so p_w = p_A r^2 / cos.
template <class F> PerSr<F> per_sr(PerM2<F> p, F r2, F cos_light) { return {p.v * r2 / cos_light}; }

/// A direction and the density it was drawn with. pdf 0: nothing was drawn, the sample has weight 0 and counts.
template <class F> struct Drawn {
    Vec3<F> wi;
    PerSr<F> pdf;
};

/// A direction that was drawn towards a light. Whether it meets that light is known from the draw; a test of the
/// rounded direction may fail: float directions are 1e-7 apart, so an area light of 1e-6 m at 3 m is only three of them
/// wide.
template <class F> struct DrawnToDisk : Drawn<F> {
    F disk;                 // the index of that light, disks first
    MaskOf<F> meets_light;  // wi meets it; it may still be behind another light, or hidden
};

/// A direction that was drawn in a texel of the sky. Rounding may move the direction to a neighbouring texel, which may
/// be far darker; its radiance is that of the texel it was drawn in.
template <class F> struct DrawnToSky : Drawn<F> {
    UintOf<F> texel;  // no_texel: none was drawn
};

/// A direction that was drawn on an emitting triangle, which it meets for any rounding of the direction.
template <class F> struct DrawnToTriangle : Drawn<F> {
    UintOf<F> triangle;  // no_triangle: none was drawn
};

/// A direction that was drawn by one of several samplers: `disk` is that of one which aimed at a light, else -1;
/// `texel` and `triangle` those of samplers which aimed there.
template <class F> struct DrawnByAny : DrawnToDisk<F> {
    static constexpr bool by_any = true;
    UintOf<F> texel{no_texel}, triangle{no_triangle};
};

/// A disk light as seen from the surface, in the local frame.
template <class F> struct LocalDisk {
    Vec3<F> to_center;  // from the surface point, m
    Vec3<F> normal;     // unit
    F radius;           // m
    F two_sided;        // 1: emits from both sides
    F power;            // Y(L) pi r^2: the weight in the choice among lights
    F along;  // to_center.normal, m; 0 if the disk's plane passes through the point, which receives nothing from it

    LocalDisk() = default;
    LocalDisk(Vec3<F> c, Vec3<F> n, F r, F sides, F share)
        : to_center(c), normal(n), radius(r), two_sided(sides), power(share) {
        const F height = dot(c, n);
        along = select(abs(height) > number<F>(1e-6) * (sqrt(dot(c, c)) + r), height, number<F>(0));
    }
    /// Returns whether the surface is in front of an emitting side.
    [[gnu::always_inline]] MaskOf<F> faces() const {
        return (along < number<F>(0)) | ((along > number<F>(0)) & (two_sided > number<F>(0)));
    }
};

/// The data of a surface point that a sampler may use.
template <class F> struct ShadingPoint {
    Vec3<F> wo;
    F s;        // Phong exponent
    F alpha;    // GGX roughness
    F diffuse;  // Y(rho_d)
    F lobe;     // rho_s
    const LocalDisk<F>* disks = nullptr;
    int disk_count = 0;
    const LocalLight<F>* others = nullptr;  // lights other than disks
    int other_count = 0;
    const Surroundings* around = nullptr;  // the scene's sky and meshes; null: none, and the next two are not set
    Vec3<F> position{};                    // of the point, from the scene's origin along the world's axes, m
    Frame<F> frame{};                      // of the point, in the world
    LobeKind lobe_kind = LobeKind::none;   // none where rho_s is 0
};

/// The light that samplers which aim only at lights cannot reach.
inline constexpr std::string_view light_arm_misses = "the fill";
inline ExpectedBehaviour theory_of_light_arm(const CasePoint& point) {
    ExpectedBehaviour t;
    if (point.fill > 0) {
        t.wrong = "support";
        t.why = "an arm that aims at lights alone cannot find the fill";
    }
    return t;
}

/// One direction per sample, from one density.
template <class S, class F>
concept DrawsOne = requires(const S arm, Vec3<F> wo, Vec3<F> wi, Vec2<F> u) {
    { arm.sample(wo, u) } -> std::convertible_to<Drawn<F>>;  // u in [0,1)^2
    { arm.pdf(wo, wi) } -> std::same_as<PerSr<F>>;           // 0 off the support
};

/// Two directions per sample, each from its own density; the weight of a direction drawn by technique t.
template <class S, class F>
concept DrawsTwo = requires(const S arm, Vec3<F> wo, Vec3<F> wi, Vec2<F> u, Drawn<F> draw) {
    requires S::techniques == 2;
    { arm.template sample_technique<0>(wo, u) } -> std::convertible_to<Drawn<F>>;
    { arm.template sample_technique<1>(wo, u) } -> std::convertible_to<Drawn<F>>;
    { arm.template pdf_technique<0>(wo, wi) } -> std::same_as<PerSr<F>>;
    { arm.template pdf_technique<1>(wo, wi) } -> std::same_as<PerSr<F>>;
    { arm.template weight<0>(wo, draw) } -> std::same_as<F>;
    { arm.template weight<1>(wo, draw) } -> std::same_as<F>;
};

/// The requirements on a sampler: a name, a description, and construction from a surface point. `theory` (CasePoint ->
/// ExpectedBehaviour) is optional.
template <class S, class F>
concept Sampler = std::constructible_from<S, const ShadingPoint<F>&> && requires {
    { S::name } -> std::convertible_to<std::string_view>;
    { S::manual } -> std::convertible_to<SamplerDoc>;
} && (DrawsTwo<S, F> || (!requires { S::techniques; } && DrawsOne<S, F>));

}  // namespace crescent
