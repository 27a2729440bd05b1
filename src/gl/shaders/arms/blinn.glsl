// blinn, as src/samplers/blinn.h: a cosine-power half-vector about n, mirrored to wi.
//   p_m = (s+1)/(2 pi) (n.m)^s;  cos = u1^(1/(s+1)), phi = 2 pi u2;  p = p_m / (4 (wo.m)).
// Blinn 1977, "Models of Light Reflection for Computer Synthesized Pictures".
#include "arms/halfway.glsl"

Drawn sample_blinn(vec3 wo, vec2 u) {
    Power root = power(u.x, 1.0 / (shading_point.s + 1.0));
    float cos = root.value;
    float sin = sqrt(root.one_minus * (1.0 + cos));
    SinCos phi = sincos_turns(u.y);
    vec3 m = vec3(sin * phi.cos, sin * phi.sin, cos);
    float p = (shading_point.s + 1.0) * (0.5 / pi) * (u.x / cos) / half_jacobian(dot(wo, m));
    vec3 wi = mirror_about(wo, m);
    return Drawn(wi, above_horizon(wo, wi, u.x > 0.0 ? p : 0.0));
}
float pdf_blinn(vec3 wo, vec3 wi) {
    vec3 m = halfway(wo, wi);
    return above_horizon(
        wo, wi, (shading_point.s + 1.0) * (0.5 / pi) * cosine_power(m, vec3(0.0, 0.0, 1.0), shading_point.s) / half_jacobian(dot(wo, m)));
}
