// ggx-vndf, as src/samplers/ggx_vndf.h: a GGX normal among those visible from wo, mirrored to wi.
//   p = G1(wo) D(m) / (4 wo.z).
// Heitz 2018, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), eqs (3) and (17); the draw by a spherical
// cap: Dupuy & Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", CGF 42(8), listing 3.
#include "arms/halfway.glsl"
#include "lobes/ggx.glsl"

float ggx_vndf_density(vec3 wo, vec3 wi, vec3 m) {
    return above_horizon(wo, wi, ggx_G1(wo, shading_point.alpha) * ggx_D(m, shading_point.alpha) / (4.0 * max(wo.z, 1e-12)));
}
Drawn sample_ggx_vndf(vec3 wo, vec2 u) {
    float a = shading_point.alpha;
    vec3 stretched = unit(vec3(a * wo.xy, wo.z));
    float rise = (1.0 - u.x) * (1.0 + stretched.z);  // z + stretched.z on the cap
    float z = rise - stretched.z;
    float sin = sqrt(max((1.0 - z) * (1.0 + z), 0.0));
    SinCos phi = sincos_turns(u.y);
    vec3 m = unit(vec3(a * (sin * phi.cos + stretched.x), a * (sin * phi.sin + stretched.y), rise));
    vec3 wi = mirror_about(wo, m);
    return Drawn(wi, ggx_vndf_density(wo, wi, m));
}
float pdf_ggx_vndf(vec3 wo, vec3 wi) { return ggx_vndf_density(wo, wi, halfway(wo, wi)); }
