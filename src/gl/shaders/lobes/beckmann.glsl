// beckmann, as src/scene/lobes/beckmann.h: D G1 G1 / (4 cos cos), separable G. Walter et al. 2007, "Microfacet Models
// for Refraction through Rough Surfaces": (25), 1/sr, (26), (20).
#include "shading_point.glsl"

float exp_of_minus(float x) {  // x >= 0
    float y = -1.4426950408889634 * x;
    return y > -126.0 ? exp2_split(y).value : 0.0;
}
float beckmann_D(vec3 m, float alpha) {
    float cos2 = sqr(m.z), x = dot(m.xy, m.xy) / (cos2 * sqr(alpha));
    return m.z > 0.0 ? exp_of_minus(x) / (pi * sqr(alpha) * max(sqr(cos2), 1e-30)) : 0.0;
}
float beckmann_G1(vec3 w, float alpha) {  // erf by Abramowitz & Stegun 1964, 7.1.26
    float sin = max(sqrt(dot(w.xy, w.xy)), 1e-30);
    float a = min(w.z / (alpha * sin), 10.0);
    float t = 1.0 / (1.0 + 0.3275911 * a);
    float high = 1.421413741 + t * (-1.453152027 + t * 1.061405429);
    float P = t * (0.254829592 + t * (-0.284496736 + t * high));
    return 2.0 / (2.0 + exp_of_minus(a * a) * (0.56418958354775629 / a - P));
}
float lobe_beckmann(vec3 wo, vec3 wi) {
    float alpha = shading_point.alpha;
    float f = beckmann_D(unit(wo + wi), alpha) * beckmann_G1(wo, alpha) * beckmann_G1(wi, alpha) / (4.0 * wo.z * wi.z);
    return wo.z > 0.0 && wi.z > 0.0 ? f : 0.0;
}
