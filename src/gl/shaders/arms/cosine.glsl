// cosine, as src/samplers/cosine.h: the hemisphere of n by projected solid angle.
//   p = (n.w)/pi;  cos = sqrt(u1), phi = 2 pi u2, about n.
#include "sampler.glsl"

float pdf_cosine(vec3 wo, vec3 wi) { return wi.z > 0.0 ? wi.z * (1.0 / pi) : 0.0; }
Drawn sample_cosine(vec3 wo, vec2 u) {
    float sin = sqrt(1.0 - u.x);
    SinCos phi = sincos_turns(u.y);
    vec3 wi = vec3(sin * phi.cos, sin * phi.sin, sqrt(u.x));
    return Drawn(wi, pdf_cosine(wo, wi));
}
