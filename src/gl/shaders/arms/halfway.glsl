// Shared by the half-vector samplers, as src/samplers/halfway.h: m is drawn about n, wi is wo mirrored in m, and
//   dw_i = 4 (wo.m) dw_m,  so    p(wi) = p_m(m) / (4 (wo.m)).        Walter et al. 2007, eq. (14)
// If wi is below the horizon nothing is drawn: the sample has weight 0 and counts.
#include "sampler.glsl"

float half_jacobian(float wo_m) { return 4.0 * max(wo_m, 1e-12); }

vec3 halfway(vec3 wo, vec3 wi) {
    vec3 sum = wo + wi;
    return sum * (1.0 / sqrt(max(dot(sum, sum), 1e-30)));
}

float above_horizon(vec3 wo, vec3 wi, float p) { return wo.z > 0.0 && wi.z > 0.0 ? p : 0.0; }

vec3 mirror_about(vec3 wo, vec3 m) { return m * (2.0 * dot(wo, m)) - wo; }
