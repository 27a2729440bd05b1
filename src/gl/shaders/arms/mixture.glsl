// mixture, as src/samplers/mixture.h: one sample from two techniques, chosen by u1: the lobe (phong, about R) with
// probability q, else cosine.
//   q = min(rho_s / (rho_s + Y(rho_d)), 9/10), and 0 on a surface without a lobe;
//   p = q p_phong + (1 - q) p_cosine;  u1 in [0, q) is stretched to [0, 1) for the lobe, the rest for the cosine.
// Hesterberg 1995, "Weighted Average Importance Sampling and Defensive Mixture Distributions".
#include "arms/cosine.glsl"
#include "arms/phong.glsl"

float mixture_q() {
    float sum = shading_point.lobe + shading_point.diffuse;
    return sum > 0.0 ? min(shading_point.lobe / sum, 0.9) : 0.0;
}
float pdf_mixture(vec3 wo, vec3 wi) {
    float q = mixture_q();
    return q * pdf_phong(wo, wi) + (1.0 - q) * pdf_cosine(wo, wi);
}
Drawn sample_mixture(vec3 wo, vec2 u) {
    float q = mixture_q();
    bool of_lobe = u.x < q;
    vec2 stretched = vec2((of_lobe ? u.x : u.x - q) / (of_lobe ? q : 1.0 - q), u.y);
    vec3 a = sample_phong(wo, stretched).wi, b = sample_cosine(wo, stretched).wi;
    vec3 wi = of_lobe ? a : b;
    return Drawn(wi, pdf_mixture(wo, wi));
}
