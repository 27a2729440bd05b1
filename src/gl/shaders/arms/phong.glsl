// phong, as src/samplers/phong.h: a cosine-power lobe about R = reflect(-wo, n). Part of it may lie below the horizon
// of n: such samples have weight 0 and count; p is not renormalised.
//   p = (s+1)/(2 pi) (w.R)_+^s;  cos = u1^(1/(s+1)), phi = 2 pi u2, about R;  (w.R)^s = u1 / cos on the drawn
//   direction.
#include "sampler.glsl"

Drawn sample_phong(vec3 wo, vec2 u) {
    Power lobe = root(u.x, 1.0 / (shading_point.s + 1.0));
    float cos = lobe.value;
    float sin = sqrt(lobe.one_minus * (1.0 + cos));
    SinCos phi = sincos_turns(u.y);
    float p = (shading_point.s + 1.0) * (0.5 / pi) * (u.x / cos);
    return Drawn(to_world(frame_about(mirror(wo)), vec3(sin * phi.cos, sin * phi.sin, cos)), p);
}
float pdf_phong(vec3 wo, vec3 wi) { return (shading_point.s + 1.0) * (0.5 / pi) * cosine_power(wi, mirror(wo), shading_point.s); }
