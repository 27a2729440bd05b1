// phong, as src/scene/lobes/phong.h: (s+2)/(2 pi) (wi.R)_+^s. Lafortune & Willems 1994, "Using the modified Phong
// BRDF".
#include "shading_point.glsl"

float lobe_phong(vec3 wo, vec3 wi) { return (shading_point.s + 2.0) * (0.5 / pi) * cosine_power(wi, mirror(wo), shading_point.s); }
