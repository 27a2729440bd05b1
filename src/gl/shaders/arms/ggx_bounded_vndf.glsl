// ggx-bounded-vndf, as src/samplers/ggx_bounded_vndf.h: like ggx-vndf, on a smaller cap.
//   p = D(m) / (2 (k wo.z + t)),  t = sqrt(alpha^2 (wo.x^2 + wo.y^2) + wo.z^2)
// Eto & Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX Reflections", eqs (5), (6) and (8) for one alpha <= 1.
#include "arms/halfway.glsl"
#include "lobes/ggx.glsl"

// k and 1 - k.
vec2 ggx_bound(vec3 wo) {
    float a2 = sqr(shading_point.alpha), s2 = sqr(1.0 + sqrt(dot(wo.xy, wo.xy))), z2 = sqr(wo.z);
    float below = 1.0 / (s2 + a2 * z2);
    return vec2((1.0 - a2) * s2 * below, a2 * (z2 + s2) * below);
}
float ggx_bounded_vndf_density(vec3 wo, vec3 wi, vec3 m) {
    float t = sqrt(sqr(shading_point.alpha) * dot(wo.xy, wo.xy) + sqr(wo.z));
    float below = 2.0 * (ggx_bound(wo).x * wo.z + t);
    return above_horizon(wo, wi, ggx_D(m, shading_point.alpha) / max(below, 1e-12));
}
Drawn sample_ggx_bounded_vndf(vec3 wo, vec2 u) {
    float a = shading_point.alpha;
    vec3 stretched = unit(vec3(a * wo.xy, wo.z));
    vec2 bound = ggx_bound(wo);
    float height = 1.0 + bound.x * stretched.z;                 // of the cap
    float drop = u.x * height;                                  // 1 - z on it
    float rise = (1.0 - u.x) * height + bound.y * stretched.z;  // z + stretched.z
    float sin = sqrt(max(drop * (2.0 - drop), 0.0));
    SinCos phi = sincos_turns(u.y);
    vec3 m = unit(vec3(a * (sin * phi.cos + stretched.x), a * (sin * phi.sin + stretched.y), rise));
    vec3 wi = mirror_about(wo, m);
    return Drawn(wi, ggx_bounded_vndf_density(wo, wi, m));
}
float pdf_ggx_bounded_vndf(vec3 wo, vec3 wi) { return ggx_bounded_vndf_density(wo, wi, halfway(wo, wi)); }
