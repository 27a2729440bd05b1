// ggx, as src/scene/lobes/ggx.h: D G1 G1 / (4 cos cos), separable G. Walter et al. 2007, "Microfacet Models for
// Refraction through Rough Surfaces": (33), 1/sr.
#include "shading_point.glsl"

float ggx_D(vec3 m, float alpha) {
    float t = dot(m.xy, m.xy) + sqr(alpha) * sqr(m.z);
    return m.z > 0.0 ? sqr(alpha) / (pi * sqr(t)) : 0.0;
}
float ggx_G1(vec3 w, float alpha) {  // (34)
    float tan2 = dot(w.xy, w.xy) / sqr(w.z);
    return 2.0 / (1.0 + sqrt(1.0 + sqr(alpha) * tan2));
}
float lobe_ggx(vec3 wo, vec3 wi) {  // (20)
    float alpha = shading_point.alpha;
    float f = ggx_D(unit(wo + wi), alpha) * ggx_G1(wo, alpha) * ggx_G1(wi, alpha) / (4.0 * wo.z * wi.z);
    return wo.z > 0.0 && wi.z > 0.0 ? f : 0.0;
}
