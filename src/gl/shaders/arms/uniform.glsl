// uniform, as src/samplers/uniform.h: the hemisphere of n, uniform in solid angle.
//   p = 1/(2 pi);  cos = u1, phi = 2 pi u2, about n.
#include "sampler.glsl"

Drawn sample_uniform(vec3 wo, vec2 u) {
    float sin = sqrt(1.0 - u.x * u.x);
    SinCos phi = sincos_turns(u.y);
    return Drawn(vec3(sin * phi.cos, sin * phi.sin, u.x), 0.5 / pi);
}
float pdf_uniform(vec3 wo, vec3 wi) { return wi.z > 0.0 ? 0.5 / pi : 0.0; }
