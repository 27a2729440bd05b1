// The lobes without their albedo, as src/lobes/brdf.h: f = rho_d / pi + rho_s lobe, a lobe in 1/sr without the cosine.
// LOBE is the kind of this draw's surfaces: 0 none, 1 Phong, 2 Blinn-Phong, 3 GGX.
#include "frame.glsl"

// (s+2)/(2 pi) (wi.R)_+^s: Lafortune & Willems 1994, "Using the modified Phong BRDF".
float lobe_phong(vec3 wo, vec3 wi, float s) { return (s + 2.0) * (0.5 / pi) * cosine_power(wi, mirror(wo), s); }

// (s+2)(s+4)/(8 pi (2^(-s/2) + s)) (n.h)^s: Giesen 2009, "Phong and Blinn-Phong normalization factors".
float lobe_blinn_phong(vec3 wo, vec3 wi, float s) {
    float half_power = s < 252.0 ? exp2_split(-0.5 * s).value : 0.0;  // 2^-126 is nothing beside s
    float scale = (s + 2.0) * (s + 4.0) / (8.0 * pi * (half_power + s));
    float f = scale * cosine_power(unit(wo + wi), vec3(0.0, 0.0, 1.0), s);
    return wo.z > 0.0 && wi.z > 0.0 ? f : 0.0;
}

// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces": (33), 1/sr.
float ggx_D(vec3 m, float alpha) {
    float t = dot(m.xy, m.xy) + sqr(alpha) * sqr(m.z);
    return m.z > 0.0 ? sqr(alpha) / (pi * sqr(t)) : 0.0;
}
float ggx_G1(vec3 w, float alpha) {  // (34)
    float tan2 = dot(w.xy, w.xy) / sqr(w.z);
    return 2.0 / (1.0 + sqrt(1.0 + sqr(alpha) * tan2));
}
float lobe_ggx(vec3 wo, vec3 wi, float alpha) {  // (20), separable G
    float f = ggx_D(unit(wo + wi), alpha) * ggx_G1(wo, alpha) * ggx_G1(wi, alpha) / (4.0 * wo.z * wi.z);
    return wo.z > 0.0 && wi.z > 0.0 ? f : 0.0;
}
