// mis-power, as src/samplers/mis.h: BRDF mixture and light by area, two samples, power heuristic.
//   w_i = p_i^2 / (p_1^2 + p_2^2)      Veach & Guibas 1995, eq. (13) with beta = 2.
#include "arms/mis.glsl"

float heuristic(float own, float other) { return 1.0 / (1.0 + sqr(other / own)); }
