// Two-sample multiple importance sampling, as src/samplers/mis.h: one direction from the BRDF's mixture, one from the
// lights (by area), each weighted by the densities of both techniques. N counts pairs.
//   X = w_1 f L cos / p_1 + w_2 f L cos / p_2,  w_1 + w_2 = 1 wherever p_1 + p_2 > 0.
// Veach & Guibas 1995, "Optimally Combining Sampling Techniques for Monte Carlo Rendering": one sample from each.
#include "arms/light_area.glsl"
#include "arms/mixture.glsl"

#define TWO_TECHNIQUES
float heuristic(float own, float other);  // of two densities in 1/sr, own > 0

float weight_of(float own, float other) { return own > 0.0 ? heuristic(own, other) : 0.0; }  // 0 was not drawn
