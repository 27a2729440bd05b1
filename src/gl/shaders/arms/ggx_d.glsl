// ggx-d, as src/samplers/ggx_d.h: a GGX normal by the distribution D(m) (n.m), mirrored to wi.
//   tan^2 = alpha^2 u1 / (1 - u1), phi = 2 pi u2;  p = D(m) (n.m) / (4 (wo.m)).
// Walter et al. 2007, eqs (33), (35), (36), (14).
#include "arms/halfway.glsl"
#include "lobes/ggx.glsl"

Drawn sample_ggx_d(vec3 wo, vec2 u) {
    float a2 = sqr(shading_point.alpha);
    float t = (1.0 - u.x) + a2 * u.x;  // cos^2 = (1 - u)/t, sin^2 = alpha^2 u / t
    float cos = sqrt((1.0 - u.x) / t), sin = shading_point.alpha * sqrt(u.x / t);
    SinCos phi = sincos_turns(u.y);
    vec3 m = vec3(sin * phi.cos, sin * phi.sin, cos);
    float p = sqr(t) * cos / (pi * a2);
    vec3 wi = mirror_about(wo, m);
    return Drawn(wi, above_horizon(wo, wi, p / half_jacobian(dot(wo, m))));
}
float pdf_ggx_d(vec3 wo, vec3 wi) {
    vec3 m = halfway(wo, wi);
    return above_horizon(wo, wi, ggx_D(m, shading_point.alpha) * m.z / half_jacobian(dot(wo, m)));
}
