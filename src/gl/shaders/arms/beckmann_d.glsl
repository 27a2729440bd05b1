// beckmann-d, as src/samplers/beckmann_d.h: a Beckmann normal by D(m) (n.m), mirrored to wi.
//   tan^2 = -alpha^2 log(1 - u1), phi = 2 pi u2;  p = D(m) (n.m) / (4 (wo.m)).
// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eqs (25), (28), (29), (14).
#include "arms/halfway.glsl"
#include "lobes/beckmann.glsl"

Drawn sample_beckmann_d(vec3 wo, vec2 u) {
    float a2 = sqr(shading_point.alpha);
    float tan2 = -a2 * 0.69314718056 * log2_from(1.0 - u.x, -u.x);
    float cos = 1.0 / sqrt(1.0 + tan2), sin = cos * sqrt(tan2);
    SinCos phi = sincos_turns(u.y);
    vec3 m = vec3(sin * phi.cos, sin * phi.sin, cos);
    float p = (1.0 - u.x) / (pi * a2 * cos * sqr(cos));
    vec3 wi = mirror_about(wo, m);
    return Drawn(wi, above_horizon(wo, wi, p / half_jacobian(dot(wo, m))));
}
float pdf_beckmann_d(vec3 wo, vec3 wi) {
    vec3 m = halfway(wo, wi);
    return above_horizon(wo, wi, beckmann_D(m, shading_point.alpha) * m.z / half_jacobian(dot(wo, m)));
}
