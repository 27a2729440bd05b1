// blinn-phong, as src/scene/lobes/blinn_phong.h: (s+2)(s+4)/(8 pi (2^(-s/2) + s)) (n.h)^s. Giesen 2009, "Phong and
// Blinn-Phong normalization factors".
#include "shading_point.glsl"

float lobe_blinn_phong(vec3 wo, vec3 wi) {
    float s = shading_point.s;
    float half_power = s < 252.0 ? exp2_split(-0.5 * s).value : 0.0;  // 2^-126 is negligible against s
    float scale = (s + 2.0) * (s + 4.0) / (8.0 * pi * (half_power + s));
    float f = scale * cosine_power(unit(wo + wi), vec3(0.0, 0.0, 1.0), s);
    return wo.z > 0.0 && wi.z > 0.0 ? f : 0.0;
}
