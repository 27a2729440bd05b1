// mis-balance, as src/samplers/mis.h: BRDF mixture and light by area, two samples, balance heuristic.
//   w_i = p_i / (p_1 + p_2)      Veach & Guibas 1995, eq. (11) with one sample from each.
#include "arms/mis.glsl"

float heuristic(float own, float other) { return 1.0 / (1.0 + other / own); }
