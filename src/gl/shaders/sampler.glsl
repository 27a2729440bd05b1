// What a sampler is, as src/arms/sampler.h: sample_<arm>(wo, u) returns a direction and the density it was drawn with;
// pdf_<arm>(wo, wi) that density, 0 off the support. Local frame (n = +z); u in [0,1)^2; pdf in 1/sr.
#include "shading_point.glsl"

// pdf 0: nothing was drawn, the sample weighs 0 and counts.
struct Drawn {
    vec3 wi;
    float pdf;
};

// A direction that was drawn towards a light: its index, and whether wi meets that light: known from the draw,
// where a test of the rounded direction may fail. Set by the arms that aim at lights.
int aimed_disk = -1;
bool aimed_met = false;
